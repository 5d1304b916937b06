"""A recorded drive, to be driven again by the simulated vehicle."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from .alignment import aligned, is_slower
from .bounded_reading import bounded
from .channel_rules import unwrapped
from .channels import Channel, Channels
from .clock_times import Clock
from .file_units import FileUnit
from .source import RecordingError
from .time_base import WHOLE

OFFERED = ("alive", "slip_control")
"""What some buses tell a controller."""

WHEELS = "omega_wheel"
"""Whose speed over ground is that of the vehicle where it was not recorded."""


@dataclass(frozen=True, eq=False)
class Drive:
    """A recorded drive in SI units, one element a sample.

    Attributes:
        name: of the file, without its ending.
        time: in s, as recorded, strictly increasing.
        v: speed of the vehicle in m/s.
        elevation: of the road in m; None if it was not recorded.
        T_mot: motor torque in N.m, motor side.
        file_units: of v and T_mot.
        offered: of OFFERED what was recorded, as it was received last; a counter that runs over is unwrapped, or left
            out where it may have run over more often than is seen.
        channels: by quantity, as they were sampled; `omega_wheel` in the place of `v` where that is the wheels'.
    """

    name: str
    time: np.ndarray
    v: np.ndarray
    elevation: np.ndarray | None
    T_mot: np.ndarray
    file_units: Mapping[str, FileUnit]
    channels: Mapping[str, Channel] = field(default_factory=dict)
    offered: Mapping[str, np.ndarray] = field(default_factory=dict)

    def heading(self, quantity: str) -> str:
        """Of the column of a quantity."""
        taken = WHEELS if quantity == "v" and WHEELS in self.channels else quantity
        return self.channels[taken].heading if taken in self.channels else quantity

    @property
    def clock(self) -> str:
        """Heading of the column of the time."""
        return self.channels["T_mot"].clock if "T_mot" in self.channels else "time"


@bounded
def read_drive(
    path: Path,
    columns: Mapping[str, str] | None = None,
    names: Sequence[Path] = (),
    databases: Sequence[Path] = (),
    cut: tuple[float | Clock | None, float | Clock | None] = WHOLE,
) -> Drive:
    """Reads a recorded drive. Columns are found by name and converted by unit; others are ignored.

    Args:
        columns: by quantity the heading of its column, where that is not to be found by name.
        names: files of aliases beside ours.
        databases: of the bus, if the file is a log of its frames.
        cut: from and to when it is read: seconds, a `Clock`, or None for its begin or end.

    Raises:
        RecordingError: names the file, the column and what is wrong. The elevation may be missing, and in the place of
            the speed of the vehicle there may be that of the wheels over ground, in km/h for example.
        MissingExtra: a package that reads such files is not installed.
    """
    recording = Channels(path, columns, names, databases, cut)
    speed = "v" if recording.has("v") or not recording.has(WHEELS) else WHEELS
    optional = [quantity for quantity in ("elevation", *OFFERED) if recording.has(quantity)]
    channels = recording.read(speed, *optional, "T_mot", optional=optional)
    if speed == WHEELS and channels[speed].unit != "m/s":
        raise RecordingError(
            f"{path}: no speed of the vehicle, and {channels[speed].heading} is none over ground, in km/h for example; "
            "--column v=HEADING says which one it is"
        )
    received = [WHEELS] if speed == WHEELS and is_slower(channels[speed], channels["T_mot"]) else []
    used = dict(channels)
    if counter := used.pop("alive", None):
        # a wrong count puts the controller into fallback; without one it drives on
        counted, uncertain = unwrapped(counter)
        used |= {} if len(uncertain) else {"alive": replace(counter, values=counted)}
    time, values = aligned(used, "T_mot", [*received, *OFFERED])
    offered = {quantity: values[quantity] for quantity in OFFERED if quantity in values}
    file_units = {"v": channels[speed].file_unit, "T_mot": channels["T_mot"].file_unit}
    elevation = values.get("elevation")
    return Drive(path.stem, time, values[speed], elevation, values["T_mot"], file_units, channels, offered)
