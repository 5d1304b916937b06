"""What a channel shows by itself: numbers that are none, cut-off peaks, spikes, jumps, counters that run over."""

from collections.abc import Iterable, Iterator

import numpy as np

from .channels import Channel
from .findings import Finding, Rule, at_samples, marked, more
from .longest_interval import longest_run
from .missing_values import ALONE, FILLED, SCALED
from .thresholds import Threshold

CUT_OFF = Threshold(
    5,
    "1",
    "samples in a row at the largest or smallest value of a channel from which on it looks cut off",
    "noise of the size of the resolution hardly leaves three",
)
LEAST = 10
"""Samples in which a spike can be told."""

WIDEST = 3
"""Samples of a spike at the most."""

BRIEF = Threshold(0.01, "s", "longest spike of more than one sample", "a bit of a test drive lasts 40 ms")
NEIGHBOURS = 15
"""Samples before and after a spike with which it is compared."""

LONE = Threshold(
    5.0,
    "1",
    "how far a spike leaves its neighbours, over the range of the 15 samples before and after it",
    "1.8 at most in 200 simulated drives at 2 ms to 0.1 s, 1.5 in the recordings",
)
LARGE = Threshold(
    0.05, "1", "the same over the range of the whole channel", "smaller ones do not move what is computed of a drive"
)
ACCELERATION = Threshold(15.0, "m/s2", "acceleration of a car", "tyres transmit 12 m/s2")
SPIKE = Threshold(
    1.0,
    "m/s",
    "smallest spike of a speed over ground",
    "0.12 m/s in the recorded trips; 0.14 m/s of messages that come late",
)
WHEEL, MOTOR = (
    Threshold(3.0, "rad/s", "smallest spike of the speed of a wheel", "that of a speed over ground, tyre of 0.3 m"),
    Threshold(30.0, "rad/s", "the same of a wheel speed on the motor side", "4.3 rad/s of messages that come late"),
)
CLIMB = Threshold(20.0, "m/s", "rate at which no road climbs", "40 % at 50 m/s")
STEP = Threshold(10.0, "m", "resolution of an elevation", "GPS resolves some metres; 0.02 m in the recorded trips")

FRAME = Threshold(
    0.002,
    "s",
    "time from one frame of motor control to the next, from which it follows whether its counter may run over between "
    "two rows more often than is seen",
    "`T_frame` of the controller",
)
PERIODS = (2**4, 2**8, 2**16, 2**32, 2**64)
"""Of counters that run over."""

SENTINEL = Rule(
    "code",
    "a number that loggers write where there is no value: -999, 65535, 3276.7, ...; it is taken for none",
    f"further from all other values than {ALONE:g} of their range, or {SCALED:g} of it if it is such a number times a "
    "resolution",
    "a signal comes to its largest value by way of others",
)
HOLE = Rule(
    "hole",
    "samples without a value that were filled by a straight line",
    f"up to {FILLED:g} s; longer ones are gaps",
    FILLED.source,
)
CLIPPED = Rule(
    "cut off",
    "motor speed or load that stays at its largest or smallest value",
    f"{CUT_OFF} samples in a row",
    "noise of the size of the resolution hardly leaves three",
)
SPIKED = Rule(
    "spike",
    f"a channel that leaves its neighbours and comes back after a sample, or up to {WIDEST} within {1e3 * BRIEF:g} ms",
    f"{LONE:g} times the range of its neighbours, and {LARGE:.0%} of that of the channel; a speed over ground "
    f"{SPIKE:g} m/s and more than {ACCELERATION:g} m/s² allow",
    f"{LONE.source}; {ACCELERATION.source}",
)
JUMP = Rule(
    "jump",
    "an elevation that jumps",
    f"{STEP:g} m and {CLIMB:g} m/s times the step of time",
    f"40 % at 50 m/s climb {CLIMB:g} m/s; GPS resolves some metres; the recorded trips have 0.02 m",
)
RUN_OVER = Rule(
    "counter",
    "a counter of frames that goes back, or may have run over between two rows; it is left out",
    f"half of its period (16, 256, 65536), at a frame every {1e3 * FRAME:g} ms",
    "beyond it the difference of two values has more than one meaning",
)
RULES = (SENTINEL, HOLE, CLIPPED, SPIKED, JUMP, RUN_OVER)


def of_channels(channels: Iterable[Channel]) -> list[Finding]:
    """What is odd in channels, each by itself and as sampled."""
    rules = (lacking, cut_off, spikes, jumps, uncertain)
    return [finding for channel in channels for rule in rules for finding in rule(channel)]


def lacking(channel: Channel) -> Iterator[Finding]:
    """Samples without a value: codes of loggers, and holes that were filled."""
    for code, times, place in channel.missing:
        rule, odd = HOLE, "has no value, and is filled by a straight line"
        if code is not None:
            rule, odd = SENTINEL, f"is {code:g}, which loggers write where there is no value, and is taken for none"
        odd += more(len(times))
        yield Finding(rule, channel.heading, float(times[0]), odd, place, marked(times))


def cut_off(channel: Channel) -> Iterator[Finding]:
    """A motor speed or load that stays at its largest or smallest value as if it were cut off.

    The motor torque is not judged: under a binary demand it stays at two values. Nor are demands and messages.
    """
    if channel.quantity != "omega_1" and not channel.quantity.startswith(("T_load", "T_wheel")):
        return
    for bound, word in ((channel.values.max(), "largest"), (channel.values.min(), "smallest")):
        first, length = longest_run(channel.values == bound)
        if length >= CUT_OFF:
            odd = (
                f"stays at its {word} value, {bound:g} {channel.unit}, for {length} samples; it may have been cut off "
                "there"
            )
            yield at_samples(channel, CLIPPED, np.arange(first, first + length), odd)
            return


def spikes(channel: Channel) -> Iterator[Finding]:
    """Samples that leave their neighbours and come back as nothing does that a car or its motor makes."""
    x = channel.values
    odd = np.zeros(len(x), dtype=bool)
    for at, ratio in excursions(channel):
        odd[at[ratio > LONE]] = True
    if channel.unit == "m/s" and len(x) >= LEAST:
        for width in range(1, WIDEST + 1):
            odd |= _off(x, width) > max(SPIKE, ACCELERATION * channel.interval * width)
    at = np.flatnonzero(odd)
    if len(at):
        k, unit = int(at[0]), channel.file_unit
        off = (x[k] - np.median(x[max(k - WIDEST, 0) : k + WIDEST + 1])) / unit.factor
        yield at_samples(
            channel, SPIKED, at, f"is {off:+.3g} {unit.printed} off its neighbours, a spike{more(len(at))}"
        )


def excursions(channel: Channel) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """By their width, indices of the samples that leave their neighbours far enough to be spikes, and how far, over the
    range of these."""
    x = channel.values
    # a flag leaves its neighbours whenever it is set
    if len(x) <= 2 * (NEIGHBOURS + WIDEST) or channel.unit == "1":
        return
    # the median takes the spikes out of the range that they are compared with
    smallest = max(LARGE * float(np.ptp(_smooth(x, WIDEST))), _smallest(channel))
    for width in range(1, WIDEST + 1):
        if width == 1 or width * channel.interval <= BRIEF * (1.0 + 1e-6):
            off = _off(x, width)
            at = np.flatnonzero(off > smallest)
            yield at, off[at] / np.maximum(_range_around(x, at, width), 1e-9 * off[at])


def _off(x: np.ndarray, width: int) -> np.ndarray:
    """How far samples are off what they would be without spikes of a width."""
    return np.abs(x - _smooth(x, width))


def _smooth(x: np.ndarray, width: int) -> np.ndarray:
    from scipy.ndimage import median_filter

    return median_filter(x, 2 * width + 1, mode="nearest")


def _smallest(channel: Channel) -> float:
    """What a spike must have at least: of what comes as messages, some are late, and their steps are no spikes."""
    if channel.unit == "m/s":
        return SPIKE
    if channel.quantity.startswith("omega_wheel"):
        return WHEEL
    return MOTOR if channel.quantity == "omega_2" else 0.0


def _range_around(x: np.ndarray, at: np.ndarray, width: int) -> np.ndarray:
    """Range of the NEIGHBOURS samples before and after those at some indices, but for `width - 1` on either side."""
    distance = np.arange(width, width + NEIGHBOURS)
    index = np.abs(at[:, None] + np.concatenate((-distance[::-1], distance)))
    index = np.where(index >= len(x), 2 * (len(x) - 1) - index, index)
    return np.ptp(x[index], axis=1) if len(at) else np.empty(0)


def jumps(channel: Channel) -> Iterator[Finding]:
    """Elevations between which no road leads."""
    if channel.quantity != "elevation":
        return
    rise, steps = np.diff(channel.values), np.diff(channel.time)
    at = np.flatnonzero(np.abs(rise) > STEP + CLIMB * steps)
    if len(at):
        k = int(at[0])
        odd = f"jumps by {rise[k]:+.4g} m within {steps[k]:.3g} s, as no road does{more(len(at), 'jump')}"
        yield at_samples(channel, JUMP, at + 1, odd)


def uncertain(channel: Channel) -> Iterator[Finding]:
    """Rows between which it is not known how far a counter of frames went."""
    if channel.quantity != "alive":
        return
    _, at = unwrapped(channel)
    if len(at):
        k, x = int(at[0]), channel.values
        odd = (
            f"goes from {x[k - 1]:g} to {x[k]:g} within {channel.time[k] - channel.time[k - 1]:.3g} s, in which a "
            f"counter up to {x.max():g} may have run over unseen, or begun anew; it is left out{more(len(at), 'row')}"
        )
        yield at_samples(channel, RUN_OVER, at, odd)


def unwrapped(counter: Channel) -> tuple[np.ndarray, np.ndarray]:
    """What a counter has that does not run over, and the indices of the samples where this is uncertain."""
    largest = counter.values.max()
    # a counter of 4, 8 or 16 bits that ran over went backwards, and put the controller into fallback
    period = next((period for period in PERIODS if period > largest), PERIODS[-1])
    values = np.unwrap(counter.values, period=period)
    steps, frames = np.diff(values), np.diff(counter.time) / FRAME
    return values, 1 + np.flatnonzero((steps < 0.0) | (frames >= 0.5 * period) & bool(steps.any()))
