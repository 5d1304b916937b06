"""A recorded drive from which a model is identified."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .alignment import aligned, is_slower
from .bounded_reading import bounded
from .channel_rules import of_channels
from .channels import Channel, Channels
from .file_units import FileUnit
from .relations import check_relations
from .signal_checks import check_signal, too_slow
from .source import RecordingError
from .thresholds import Threshold
from .time_base import WHOLE, Break, Cut, interval_of

BASE = "omega_1"
"""Whose samples are the time base."""

WHEEL_SPEEDS = (("omega_2",), ("omega_wheel",), ("omega_wheel_L", "omega_wheel_R"))
LOADS = (("T_load",), ("T_wheel",), ("T_wheel_L", "T_wheel_R"))
"""What each may have been recorded as; the first that a file has is taken."""

LOADED = [load for form in LOADS for load in form]

MESSAGE = ("valid", "counter")

PIECE = Threshold(
    1.0, "s", "length of a piece between gaps from which on it is used", "the filter has found its state after 0.2 s"
)
NAMED = 3
"""Gaps that are named one by one."""

HELD = (*MESSAGE, "T_ref")
"""What a recording may have beside them, and what holds until the next sample."""


@dataclass(frozen=True, eq=False)
class Measurement:
    """A recording in SI units, motor side, one element a sample.

    Attributes:
        name: of the file, without its ending.
        time: in s, as recorded, strictly increasing; what cannot be used is left out, so that it may have gaps.
        T_mot: motor torque in N.m.
        omega_1: motor speed in rad/s.
        omega_2: wheel speed times i in rad/s.
        valid: whether the wheel speed is, as the bus says; None if it was not recorded.
        counter: one more with every message of the wheel speed; None if it was not recorded.
        T_load: load torque in N.m, negative when it brakes; None if it was not recorded.
        T_ref: torque demand in N.m, each held until the next; None if it was not recorded.
        columns: heading of the column by quantity.
        warnings: what is odd but can be used, a sentence each.
        file_units: of T_mot, omega_1, omega_2 and T_load.
    """

    name: str
    time: np.ndarray
    T_mot: np.ndarray
    omega_1: np.ndarray
    omega_2: np.ndarray
    valid: np.ndarray | None
    counter: np.ndarray | None
    T_load: np.ndarray | None
    T_ref: np.ndarray | None
    columns: Mapping[str, str]
    warnings: Sequence[str]
    file_units: Mapping[str, FileUnit]


@bounded
def read_measurement(
    path: Path,
    i: float,
    r: float,
    columns: Mapping[str, str] | None = None,
    names: Sequence[Path] = (),
    databases: Sequence[Path] = (),
    cut: Cut = WHOLE,
) -> Measurement:
    """Reads a recording to identify a model from. Columns are found by name and converted by unit; others are ignored.

    The wheel speed may be there as speed of the wheels or as speed over ground, one for both driven wheels or one
    each, of which the mean is taken; it counts i times. The load torque may be that of measurement wheels, which show
    it positive when they drive, one for both or one each, of which the sum is taken: T_load = -T_wheel/i.

    Args:
        i: gear ratio.
        r: radius of the tyre in m.
        columns: by quantity the heading of its column, where that is not to be found by name.
        names: files of aliases beside ours.
        databases: of the bus, if the file is a log of its frames.
        cut: from and to when it is read, in s, or a `Clock`.

    Raises:
        RecordingError: names the file, the column and what is wrong: a column that is missing, unreadable or in
            another unit, a signal that is frozen or impossible, signals that contradict each other.
        MissingExtra: a package that reads such files is not installed.
    """
    recording = Channels(path, columns, names, databases, cut)
    wheels, loads = _present(recording, WHEEL_SPEEDS) or ("omega_wheel",), _present(recording, LOADS)
    _require_columns(recording, BASE, "T_mot", *wheels)
    held = [quantity for quantity in HELD if recording.has(quantity)]
    needed = (BASE, "T_mot", *wheels, *loads, *held)
    # one gap made a recording useless, though the filter can begin anew behind it
    pieces, breaks = recording.read_pieces(*needed, optional=(*loads, *held), shortest=PIECE)
    pieces.sort(key=lambda piece: -np.ptp(piece[BASE].time))
    channels = pieces[0]  # the longest, by which the recording is judged
    held = [quantity for quantity in held if quantity in channels]
    loads = loads if all(load in channels for load in loads) else ()
    judged = [
        channel
        for quantity, channel in channels.items()
        if quantity not in MESSAGE and (quantity not in LOADED or quantity in loads)
    ]
    for channel in judged:
        check_signal(path, channel)
    received = {*held, *(wheel for wheel in wheels if is_slower(channels[wheel], channels[BASE]))}
    parts = []
    for piece in pieces:
        kept = {quantity: of for quantity, of in piece.items() if quantity not in LOADED or quantity in loads}
        time, values = aligned(kept, BASE, received)
        signals = {"T_mot": values["T_mot"], BASE: values[BASE], "omega_2": _wheel_speed(kept, values, wheels, i, r)}
        if loads:
            signals["T_load"] = _load(values, loads, i)
        parts.append({"time": time, **signals, **{name: values[name] for name in held}})
    longest = parts[0]
    signals = {name: longest[name] for name in ("T_mot", BASE, "omega_2", "T_load", "T_ref") if name in longest}
    parts.sort(key=lambda part: part["time"][0])
    values = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    headings = {quantity: channels[quantity].heading for quantity in ("T_mot", BASE, "T_ref") if quantity in channels}
    for quantity, measured in (("omega_2", wheels), ("T_load", loads)):
        headings[quantity] = " and ".join(channels[wheel].heading for wheel in measured)
    check_relations(path, headings, interval_of(longest["time"]), signals)
    return Measurement(
        path.stem,
        values["time"],
        values["T_mot"],
        values["omega_1"],
        values["omega_2"],
        values["valid"] > 0.5 if "valid" in values else None,
        values.get("counter"),
        values.get("T_load"),
        values.get("T_ref"),
        {quantity: heading for quantity, heading in headings.items() if heading},
        [*_between(breaks, len(parts)), *(f"{path}, {finding}" for finding in of_channels(judged))],
        _written(channels, wheels, loads, i, r),
    )


def _between(breaks: Sequence[Break], pieces: int) -> list[str]:
    """What to say of what is between pieces."""
    what = [break_.problem for break_ in breaks[:NAMED]]
    if breaks[NAMED:]:
        what.append(f"and {len(breaks) - NAMED} more")
    used = f"{pieces} pieces are" if pieces > 1 else "one piece is"
    return [f"{'; '.join(what)}: {used} used, each of {PIECE:g} s or more"] if breaks else []


def _require_columns(recording: Channels, *needed: str) -> None:
    """Refuses a recording with columns that are missing, and says too which samples are too far apart."""
    if missing := recording.missing(*needed):
        there = [] if "time" in missing else [quantity for quantity in needed if quantity not in missing]
        # else the rate is refused in the try after the last column is named
        slow = filter(None, map(too_slow, recording.read(*there).values() if there else ()))
        raise RecordingError("; ".join([str(recording.absence(missing)), *slow]))


def _present(recording: Channels, forms: Sequence[tuple[str, ...]]) -> tuple[str, ...]:
    """The first form in which the file has it; none."""
    return next((form for form in forms if all(recording.has(quantity) for quantity in form)), ())


def _written(
    channels: Mapping[str, Channel], wheels: Sequence[str], loads: Sequence[str], i: float, r: float
) -> dict[str, FileUnit]:
    """What is on the motor side in the recording is in the file where it was measured."""
    units = {quantity: channels[quantity].file_unit for quantity in ("T_mot", BASE)}
    wheel = channels[wheels[0]]
    if wheels == ("omega_2",):
        units["omega_2"] = wheel.file_unit._replace(side="motor side")
    elif wheel.unit == "m/s":
        units["omega_2"] = FileUnit(wheel.file_unit.unit, wheel.file_unit.factor * i / r, "over ground")
    else:
        units["omega_2"] = FileUnit(wheel.file_unit.unit, wheel.file_unit.factor * i, "wheel side")
    if loads:
        load = channels[loads[0]].file_unit
        at_motor = loads == ("T_load",)
        units["T_load"] = load._replace(
            factor=load.factor if at_motor else load.factor / i, side="motor side" if at_motor else "wheel side"
        )
    return units


def _wheel_speed(
    channels: Mapping[str, Channel], values: Mapping[str, np.ndarray], wheels: Sequence[str], i: float, r: float
) -> np.ndarray:
    """In rad/s, motor side."""
    if wheels == ("omega_2",):
        return values["omega_2"]
    speeds = [values[wheel] / r if channels[wheel].unit == "m/s" else values[wheel] for wheel in wheels]
    return i * np.mean(speeds, axis=0)


def _load(values: Mapping[str, np.ndarray], loads: Sequence[str], i: float) -> np.ndarray:
    """In N.m, motor side, negative when it brakes."""
    if loads == ("T_load",):
        return values["T_load"]
    return -np.sum([values[load] for load in loads], axis=0) / i
