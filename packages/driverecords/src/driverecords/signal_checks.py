"""What a channel must have so that a model can be identified from it; nothing is repaired, all is named."""

from pathlib import Path

import numpy as np

from .channels import Channel
from .quantities import QUANTITIES
from .source import RecordingError
from .thresholds import Threshold

SHORTEST = Threshold(2.0, "s", "length of a recording to identify from", "sixteen periods of a drive train of 8 Hz")


def check_signal(path: Path, channel: Channel) -> None:
    """
    Raises:
        RecordingError: it is too short, too slow, or does not vary enough to tell anything.
    """
    declared, length = QUANTITIES[channel.quantity], channel.time[-1] - channel.time[0]
    if length < SHORTEST:
        raise RecordingError(
            f"{path}: {channel.heading} is {length:g} s long; {SHORTEST:g} s or more are needed to identify anything"
        )
    if problem := too_slow(channel):
        raise RecordingError(f"{path}: {problem}")
    swing = float(np.ptp(channel.values))
    if not swing > declared.least_swing:
        raise RecordingError(
            f"{path}: {channel.heading} varies by {swing:g} {channel.unit}; "
            f"more than {declared.least_swing:g} {channel.unit} are needed to identify anything"
        )


def too_slow(channel: Channel) -> str:
    """What to say of a channel with too few samples; "" of one with enough."""
    slowest = QUANTITIES[channel.quantity].slowest
    if channel.interval <= slowest * (1.0 + 1e-6):  # the last digits of written times must not decide
        return ""
    return (
        f"{channel.heading} has a sample every {1e3 * channel.interval:g} ms; "
        f"{1e3 * slowest:g} ms or less are needed to identify anything"
    )
