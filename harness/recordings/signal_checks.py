"""What a channel must have so that a model can be identified from it; nothing is repaired, all is named."""

from pathlib import Path

import numpy as np

from .channels import Channel
from .quantities import QUANTITIES
from .source import RecordingError

SHORTEST = 2.0
"""Length in s below which a recording is refused: sixteen periods of a drive train of 8 Hz."""


def check_signal(path: Path, channel: Channel) -> None:
    """
    Raises:
        RecordingError: it is too short, too slow, or does not vary enough to tell anything.
    """
    declared, time = QUANTITIES[channel.quantity], channel.time
    length, interval = time[-1] - time[0], float(np.median(np.diff(time)))
    if length < SHORTEST:
        raise RecordingError(
            f"{path}: {channel.heading} is {length:g} s long; {SHORTEST:g} s or more are needed to identify anything"
        )
    # the last digits of written times must not decide
    if interval > declared.slowest * (1.0 + 1e-6):
        raise RecordingError(
            f"{path}: {channel.heading} has a sample every {1e3 * interval:g} ms; "
            f"{1e3 * declared.slowest:g} ms or less are needed to identify anything"
        )
    swing = float(np.ptp(channel.values))
    if not swing > declared.least_swing:
        raise RecordingError(
            f"{path}: {channel.heading} varies by {swing:g} {channel.unit}; "
            f"more than {declared.least_swing:g} {channel.unit} are needed to identify anything"
        )
