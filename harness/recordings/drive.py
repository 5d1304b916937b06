"""A recorded drive, to be driven again by the simulated vehicle."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .alignment import aligned
from .channels import Channels

QUANTITIES = ("v", "elevation", "T_mot")
"""What a drive consists of beside the time."""


@dataclass(frozen=True, eq=False)
class Drive:
    """A recorded drive in SI units, one element a sample.

    Attributes:
        name: of the file, without its ending.
        time: in s, as recorded, strictly increasing.
        v: speed of the vehicle in m/s.
        elevation: of the road in m; None if it was not recorded.
        T_mot: motor torque in N.m, motor side.
    """

    name: str
    time: np.ndarray
    v: np.ndarray
    elevation: np.ndarray | None
    T_mot: np.ndarray


def read_drive(path: Path, columns: Mapping[str, str] | None = None, names: Sequence[Path] = ()) -> Drive:
    """Reads a recorded drive. Columns are found by name and converted by unit; others are ignored.

    Args:
        columns, names: see `harness.recordings.channels.Channels`.

    Raises:
        RecordingError: see `harness.recordings.channels.Channels.read`; the elevation may be missing.
    """
    recording = Channels(path, columns, names)
    present = [quantity for quantity in QUANTITIES if quantity != "elevation" or recording.has(quantity)]
    time, channels = aligned(recording.read(*present), base="T_mot")
    return Drive(path.stem, time, channels["v"], channels.get("elevation"), channels["T_mot"])
