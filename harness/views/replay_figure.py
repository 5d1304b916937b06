"""Figure of a recorded drive: the speed against the recorded one, how far the gear torque swings, a close-up for each
controller; in the units of the recording."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from driverecords.file_units import FileUnit

from ..loop import roles
from ..metrics.declaration import Absent
from ..metrics.oscillation import amplitude
from ..metrics.spectrum import band_rms
from .annotations import GAP, gap
from .colours import BLACK, BLUE, GREY
from .figure_options import PLAIN, FigureOptions
from .figure_style import plot
from .panels import DOTTED, Axis, Curve, Panel
from .signal_lines import Line, Look, Runs, column, envelope_of, interval, looks_of

USUAL_UNITS = {"v": FileUnit("km/h", 1.0 / 3.6), "T_mot": FileUnit("N.m")}

PIECE, PIECES = 6.0, 5
"""Length in s of the roughest pieces, and how many there are."""

STRIDE, ALIKE = 0.1, 0.99
"""Time in s from one to the next, and over the roughest what is about as rough."""

LEAD = 1.0
"""Time in s before the roughest piece from which on a close-up shows it."""


def plot_replay(
    runs: Runs,
    recorded: tuple[np.ndarray, np.ndarray],
    title: str,
    stem: Path,
    options: FigureOptions = PLAIN,
    file_units: Mapping[str, FileUnit] | None = None,
) -> list[Path]:
    """Draws the rides of a recorded drive.

    Args:
        runs: signals by the names of the rides, the undamped one first, with `time`, `plant.v`, `plant.T_gear` and
            `controller.T_driver`.
        recorded: time in s and speed in m/s of the recording.
        title: of the figure.
        stem: path of the files without their ending.
        file_units: of `v` and `T_mot` in the recording; None: km/h and N.m.

    Returns:
        The files written.
    """
    undamped, *others = runs
    t, looks = runs[undamped]["time"], looks_of(runs)
    v, torque = ((file_units or USUAL_UNITS)[name] for name in USUAL_UNITS)
    window = options.clipped(float(t[0]), float(t[-1]))
    ((start, _), *_) = roughest(runs[undamped])
    before = max(start - LEAD, float(t[0]))
    closer = window if options.window else (before, min(start + PIECE, float(t[-1])))
    pairs = [others[k : k + 2] for k in range(0, len(others), 2)]
    panels = [
        speeds(runs[others[0]], recorded, f"simulated, {others[0]}", v),
        *(swings({each: runs[each] for each in (undamped, *pair)}, looks, torque) for pair in pairs),
        *(torques({each: runs[each] for each in (undamped, name)}, looks, torque, closer) for name in others),
    ]
    return plot([[panel] for panel in panels], Axis("time in s", window), title, stem, options, size=(7.2, 2.3))


def speeds(run: np.ndarray, recorded: tuple[np.ndarray, np.ndarray], label: str, v: FileUnit) -> Panel:
    """The speed of a ride against the recorded one."""
    curve = Curve(recorded[0], recorded[1] / v.factor, "recorded", GREY, width=2.5)
    return Panel(f"speed {v}", [curve, *Line(column(roles.BODY_SPEED, 1.0 / v.factor), label, BLUE).of(run)])


def swings(runs: Runs, looks: Mapping[str, Look], unit: FileUnit) -> Panel:
    """The envelope of the gear torque of all rides."""
    signal = envelope_of(roles.GEAR_TORQUE, 1.0 / unit.factor)
    curves = [c for name, run in runs.items() for c in Line(signal, _with_rms(name, run, unit), *looks[name]).of(run)]
    return Panel(f"gear torque, 5-50 Hz\nenvelope {unit}", curves, bounds=(0.0, None), columns=2)


def torques(runs: Runs, looks: Mapping[str, Look], unit: FileUnit, closer: tuple[float, float] | None = None) -> Panel:
    """The gear torque of rides, with the demand of the last one and, in a close-up, when its teeth are apart."""
    T_gear, T_driver = (column(name, 1.0 / unit.factor) for name in (roles.GEAR_TORQUE, roles.DEMAND))
    last = list(runs.values())[-1]
    curves = [curve for name, run in runs.items() for curve in Line(T_gear, name, *looks[name]).of(run)]
    curves += Line(T_driver, "demand", BLACK, DOTTED, 1.1).of(last)
    parts = [gap(last, GAP), *curves] if closer else curves
    return Panel(f"gear torque\n{unit}", parts, x=Axis("time in s", closer) if closer else None)


def _with_rms(name: str, run: np.ndarray, unit: FileUnit) -> str:
    """The name of a ride and the rms of its gear torque from 5 to 50 Hz."""
    try:
        rms = band_rms(run[roles.GEAR_TORQUE], interval(run))
    except Absent:
        return name
    return f"{name}, rms {rms / unit.factor:.3g} {unit.printed}"


def roughest(run: np.ndarray) -> list[tuple[float, float]]:
    """Beginnings in s, to STRIDE, of the pieces with the largest mean swing of the gear torque about the demand, which
    do not overlap, and that swing in N.m. Of pieces that swing about as much the middle one is taken."""
    T_s = interval(run)
    length = min(round(PIECE / T_s), len(run) - 1)
    starts = np.unique([*range(0, len(run) - length, max(round(STRIDE / T_s), 1)), len(run) - 1 - length])
    sums = np.cumsum(np.insert(swinging(run), 0, 0.0))
    means = (sums[np.minimum(starts + length, len(sums) - 1)] - sums[starts]) / length
    found = list[tuple[float, float]]()
    while len(found) < PIECES and means.max() > -np.inf:
        first = int(np.argmax(means))
        less = np.flatnonzero(means[first:] < ALIKE * means[first])
        k = first + (int(less[0]) if len(less) else len(means) - first) // 2
        found.append((float(run["time"][starts[k]]), float(means[k])))
        means[abs(starts - starts[k]) < length] = -np.inf
    return found


def swinging(run: np.ndarray) -> np.ndarray:
    """How far the gear torque swings about the demand, in N.m."""
    return amplitude(run[roles.GEAR_TORQUE] - run[roles.DEMAND], interval(run))
