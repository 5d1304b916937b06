"""What a channel must have so that a model can be identified from it; nothing is repaired, all is named."""

from pathlib import Path

import numpy as np

from ..base.longest_interval import longest_run
from .channels import Channel
from .quantities import QUANTITIES
from .source import RecordingError

SHORTEST = 2.0
"""Length in s below which a recording is refused: sixteen periods of a drive train of 8 Hz."""

CLIPPED = 5
"""Samples in a row at the largest or smallest value of a channel from which on it looks cut off there. Noise of the
size of the resolution hardly leaves three."""


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


def clipping(channel: Channel) -> str | None:
    """The message about a channel that stays at its largest or smallest value as if it were cut off, else None.

    The motor torque is not judged: under a binary demand it stays at two values.
    """
    for bound, word in ((channel.values.max(), "largest"), (channel.values.min(), "smallest")):
        first, length = longest_run(channel.values == bound)
        if length >= CLIPPED:
            return (
                f"{channel.where(first)}: {channel.heading} stays at its {word} value, {bound:g} {channel.unit}, "
                f"for {length} samples; it may have been cut off there"
            )
    return None
