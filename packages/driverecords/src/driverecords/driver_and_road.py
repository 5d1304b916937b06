"""The course of what a driver and a road do, as a manoeuvre takes it from a table."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .alignment import aligned
from .bounded_reading import bounded
from .channels import Channel, Channels
from .source import RecordingError

OPTIONAL = ("T_brake", "slope")


@dataclass(frozen=True, eq=False)
class Course:
    """Corners of straight lines, in SI units.

    Attributes:
        time: in s from the first row on; two corners at one instant are a jump.
        signals: T_driver in N.m and, where the file has them, T_brake in N.m and slope in rad, a value an instant.
        v_0: speed of the vehicle at the start in m/s, 0 where the file has no speed.
    """

    time: np.ndarray
    signals: Mapping[str, np.ndarray]
    v_0: float


@bounded
def read_course(path: Path) -> Course:
    """Reads a file that a manoeuvre is drawn from.

    Raises:
        RecordingError: see `driverecords.channels.Channels.read`; only T_driver must be there.
    """
    try:
        return _course(Channels(path))
    except RecordingError as refusal:
        raise RecordingError(refusal.problem) from refusal  # what is drawn has no options


def _course(recording: Channels) -> Course:
    quantities = ["T_driver", *(quantity for quantity in (*OPTIONAL, "v") if recording.has(quantity))]
    channels = recording.read(*quantities, optional=quantities[1:], drawn=True)
    time, values = aligned(channels, base="T_driver")
    v_0 = float(values.pop("v")[0]) if "v" in values else 0.0
    if "slope" in values:
        values["slope"] = _angle(channels["slope"], values["slope"])
    return Course(time - time[0], values, v_0)


def _angle(channel: Channel, values: np.ndarray) -> np.ndarray:
    """A slope in rad, of one in rad or of its tangent."""
    return values if channel.unit == "rad" else np.arctan(values)
