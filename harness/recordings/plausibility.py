"""Whether a recording can be true. Each rule looks for one thing that files have in spite of being well-formed, and
gives at most one finding a channel: column, time, and what is odd. Nothing is repaired, and nothing refused.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from math import pi
from shlex import quote
from typing import Any, NamedTuple

import numpy as np

from ..base.longest_interval import longest_run
from .channels import Channel
from .drive import Drive
from .force_balance import FORCE, LARGEST, LEAST, SIGNED, SMALLEST, TOGETHER, Car, balance, forces, interval_of
from .headings import split
from .missing_values import is_code


class Rule(NamedTuple):
    """What is odd.

    Attributes:
        name: for tables and tools.
        looks_for: in words.
        threshold: from when on it is found.
        reason: where the threshold comes from: physics, or what was measured.
    """

    name: str
    looks_for: str
    threshold: str
    reason: str


@dataclass(frozen=True)
class Finding:
    """What is odd in a recording.

    Attributes:
        column: its heading.
        time: of the recording, in s.
        odd: what, to stand after column and time.
        place: in the file, as in "line 12"; empty where no single one is meant.
        samples: times in s of all samples that are odd so, or MOST_MARKED of them.
    """

    rule: Rule
    column: str
    time: float
    odd: str
    place: str = ""
    samples: tuple[float, ...] = ()

    def __str__(self) -> str:
        return f"{self.place}{self.place and ': '}{self.column} at {self.time:.6g} s {self.odd}"

    def document(self) -> dict[str, Any]:
        """For tools."""
        return {"rule": self.rule.name, "column": self.column, "time_s": self.time, "text": str(self)}


ALONE = 0.5
"""Distance of a code from the other values, over the range of these, from which on it is none of them."""

CUT_OFF = 5
"""Samples in a row at the largest or smallest value of a channel from which on it looks cut off there. Noise of the
size of the resolution hardly leaves three."""

ACCELERATION, SPIKE, WIDEST = 15.0, 1.0, 3
"""Acceleration in m/s2, of a car into a wall of tyres; speed in m/s, and samples, of a spike."""

CLIMB, STEP = 20.0, 10.0
"""Rate in m/s at which no road climbs, and the resolution in m that an elevation may have."""

OSCILLATION, SLOWEST = 8.0, 0.2
"""Frequency of a drive train in Hz, and the longest interval of a demand in s."""

BEYOND = 0.01
"""Share of the samples that may lie beyond T_max."""

MOST_MARKED = 200
"""Samples of a finding that a figure marks."""

SHORTEST = 2e-4
"""Interval in s of the fastest recordings. What would be faster in ms is not tried in them."""

KMH, MS, WEAK = 3.6, 1e-3, (4.0, 16.0, 64.0, 256.0, 1000.0)
"""Factors on speed, time and torque that are tried. Those on a torque that never reaches FORCE leave no ratio out."""

LIVELY, OWN = 600.0, 0.3
"""Standard deviation in N of what drives a car, and its correlation with what the motor gives. Roads that rise and fall
by 5 % take as much; by 14 %, they leave that correlation."""

FOLLOWED = 0.3
"""Speed error in m/s, rms, from which on a recorded speed is not followed."""

SENTINEL = Rule(
    "code",
    "a number that loggers write where there is no value: -999, 65535, ...",
    f"further from all other values than {ALONE:g} of their range",
    "a signal comes to its largest value by way of others",
)
CLIPPED = Rule(
    "cut off",
    "motor speed or load that stays at its largest or smallest value",
    f"{CUT_OFF} samples in a row",
    "noise of the size of the resolution hardly leaves three",
)
SPIKED = Rule(
    "spike",
    f"a speed over ground that leaves and comes back within {WIDEST} samples",
    f"{SPIKE:g} m/s and more, and more than {ACCELERATION:g} m/s² allow",
    "tyres transmit 12 m/s²; the recorded trips have 0.12 m/s",
)
JUMP = Rule(
    "jump",
    "an elevation that jumps",
    f"{STEP:g} m and {CLIMB:g} m/s times the step of time",
    f"40 % at 50 m/s climb {CLIMB:g} m/s; GPS resolves some metres; the recorded trips have 0.02 m",
)
RATE = Rule(
    "rate",
    "a demand that is sampled too slowly to excite a drive train",
    f"more than {SLOWEST:g} s between samples",
    "a ramp of the length h leaves at most 1/(π f h) of the swing after a step, here "
    f"{1.0 / (pi * OSCILLATION * SLOWEST):.2g} at {OSCILLATION:g} Hz",
)
CAPPED = Rule(
    "T_max",
    "motor torque that the motor cannot make and that is cut off",
    f"more than {BEYOND:.0%} of the samples beyond `motor.T_max`",
    "0.1 % in trip a11 of a motor with 250 N·m",
)
SIGN = Rule(
    "sign of torque",
    "motor torque that pushes when the car slows down, and the reverse",
    f"correlation of the forces below {-SIGNED:g}",
    "0.91 and more in the recorded trips, 0.9 and more in 200 simulated drives",
)
RATIO = Rule(
    "ratio of torque",
    "a motion that takes another force than the motor gives: wrong unit, side of the gear, car",
    f"below {SMALLEST:g} or above {LARGEST:g}, correlation {TOGETHER:g} and more",
    "0.84 and 0.92 in the recorded trips; 0.61 to 1.82 in 200 simulated drives of cars with half to one and a half of "
    "the mass",
)
OTHER = Rule(
    "other torque",
    "motor torque that has nothing to do with what drives the car: of another drive or channel, or late",
    f"correlation below {OWN:g} where {LIVELY:g} N (standard deviation) and more drive it",
    "0.92 and more in the recorded trips; 0.3 on a road that rises and falls by 14 %",
)
FAST = Rule(
    "unit of speed",
    "km/h called m/s: the car is 3.6 times too fast",
    f"the motion takes more than {LARGEST:g} times what the motor gives, and would fit in km/h",
    "as ratio of torque; the recorded trips have 2.9 and 3.2 then",
)
SLOW_TIME = Rule(
    "unit of time",
    "ms called s: the motion takes a thousandth of what the motor gives",
    f"correlation less than {TOGETHER:g}, but that and the right ratio in ms; {SHORTEST / MS:g} s between samples",
    "as ratio of torque",
)
FOLLOWING = Rule(
    "following",
    "after the drive: a recorded speed that the simulated car does not keep",
    f"{FOLLOWED:g} m/s rms without damping",
    "the force along the road is corrected until 0.1 m/s are reached; 0.16 m/s at most in 200 simulated drives",
)

RULES = (SENTINEL, CLIPPED, SPIKED, JUMP, RATE, CAPPED, SIGN, RATIO, OTHER, FAST, SLOW_TIME, FOLLOWING)
"""All that is looked for."""


def of_channels(channels: Iterable[Channel]) -> list[Finding]:
    """What is odd in channels, each by itself and as sampled."""
    rules = (codes, cut_off, spikes, jumps)
    return [finding for channel in channels for rule in rules for finding in rule(channel)]


def of_drive(drive: Drive, car: Car, T_max: float) -> list[Finding]:
    """What is odd in a drive that a car is to follow. Its rate is not judged where its times are wrong.

    Args:
        T_max: largest torque of its motor in N.m.
    """
    motion = list(unbalanced(drive, car))
    rate = [] if any(finding.rule is SLOW_TIME for finding in motion) else slow_sampling(drive)
    return [*of_channels(drive.channels.values()), *rate, *beyond_T_max(drive, T_max), *motion]


def codes(channel: Channel) -> Iterator[Finding]:
    """Numbers that stand for a missing value."""
    written = channel.values / channel.file_unit.factor
    coded = np.array([is_code(value) for value in (written.min(), written.max())])
    for value in np.array([written.min(), written.max()])[coded]:
        at = np.flatnonzero(written == value)
        others = written[written != value]
        if len(others) and np.abs(others - value).min() > ALONE * np.ptp(others):
            odd = f"is {value:g}, which loggers write where there is no value{_more(len(at))}"
            yield _of(channel, SENTINEL, at, odd)


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
            yield _of(channel, CLIPPED, np.arange(first, first + length), odd)
            return


def spikes(channel: Channel) -> Iterator[Finding]:
    """Samples of a speed over ground that no motion explains."""
    if channel.unit != "m/s" or len(channel.values) < LEAST:
        return
    from scipy.ndimage import median_filter

    v, interval = channel.values, interval_of(channel.time)
    odd = np.zeros(len(v), dtype=bool)
    for width in range(1, WIDEST + 1):
        off = np.abs(v - median_filter(v, 2 * width + 1, mode="nearest"))
        odd |= off > max(SPIKE, ACCELERATION * interval * width)
    at = np.flatnonzero(odd)
    if len(at):
        k, unit = int(at[0]), channel.file_unit
        off = (v[k] - np.median(v[max(k - WIDEST, 0) : k + WIDEST + 1])) / unit.factor
        yield _of(channel, SPIKED, at, f"is {off:+.3g} {unit.printed} off its neighbours, a spike{_more(len(at))}")


def jumps(channel: Channel) -> Iterator[Finding]:
    """Elevations between which no road leads."""
    if channel.quantity != "elevation":
        return
    rise, steps = np.diff(channel.values), np.diff(channel.time)
    at = np.flatnonzero(np.abs(rise) > STEP + CLIMB * steps)
    if len(at):
        k = int(at[0])
        odd = f"jumps by {rise[k]:+.4g} m within {steps[k]:.3g} s, as no road does{_more(len(at), 'jump')}"
        yield _of(channel, JUMP, at + 1, odd)


def slow_sampling(drive: Drive) -> Iterator[Finding]:
    """A demand between whose samples the oscillation has no room."""
    interval = interval_of(drive.time)
    # the last digits of written times must not decide
    if interval > SLOWEST * (1.0 + 1e-6):
        swing = 1.0 / (pi * OSCILLATION * interval)
        yield Finding(
            RATE,
            drive.heading("T_mot"),
            float(drive.time[0]),
            f"has a sample every {interval:.3g} s: straight lines between them leave {swing:.1%} of the swing that a "
            f"step excites at {OSCILLATION:g} Hz, so the ride cannot show what damping is worth; "
            f"{SLOWEST:g} s or less are needed",
        )


def beyond_T_max(drive: Drive, T_max: float) -> Iterator[Finding]:
    """Torques that are cut off."""
    beyond = np.abs(drive.T_mot) > T_max
    if beyond.mean() > BEYOND:
        k = int(np.argmax(np.abs(drive.T_mot)))
        yield Finding(
            CAPPED,
            drive.heading("T_mot"),
            float(drive.time[k]),
            f"is {drive.T_mot[k]:.4g} N.m; {beyond.mean():.1%} of the samples lie beyond T_max = {T_max:g} N.m of the "
            "motor and are cut off there (--set motor.T_max=...)",
            samples=_marked(drive.time[beyond]),
        )


def unbalanced(drive: Drive, car: Car) -> Iterator[Finding]:
    """A motion that is not that of this torque and this car: one finding, of what explains it best."""

    def fits(time: float = 1.0, v: float = 1.0) -> bool:
        return balance(forces(time * drive.time, v * drive.v, drive.T_mot, car)).fits

    def is_weak(factor: float) -> bool:
        weak = balance(along, factor)
        return weak.fits and weak.moved > FORCE

    along = forces(drive.time, drive.v, drive.T_mot, car)
    found, torque = balance(along), drive.heading("T_mot")
    at = found.worst
    if found.correlation < -SIGNED:
        odd = (
            f"pushes when the car slows down, and the reverse (correlation {found.correlation:.2f}): its sign looks "
            f"wrong; {_given('T_mot', f'-{torque}')} turns it"
        )
        yield Finding(SIGN, torque, at, odd)
    elif found.judged and found.together < TOGETHER and MS * interval_of(drive.time) >= SHORTEST and fits(time=MS):
        clock = drive.clock
        odd = (
            f"goes on by {interval_of(drive.time):.4g} s a sample, and motion and torque fit if that is ms: its unit "
            f"looks wrong; {_given('time', f'{split(clock)[0]} [ms]')} gives it"
        )
        yield Finding(SLOW_TIME, clock, float(drive.time[0]), odd)
    elif found.judged and found.together >= TOGETHER and found.ratio > LARGEST and fits(v=1.0 / KMH):
        speed = drive.heading("v")
        odd = (
            f"changes as if the motor had {found.ratio:.2g} times its torque, and fits if it is {KMH:g} times too "
            f"large, km/h called m/s ({_given('v', f'{split(speed)[0]} [km/h]')}); else torque, i, r or m are wrong"
        )
        yield Finding(FAST, speed, at, odd)
    elif found.judged and found.together >= TOGETHER and not found.fits:
        odd = (
            f"gives {1.0 / found.ratio:.2g} times what the motion takes (correlation {found.together:.2f}): its unit "
            "or the side of the gear looks wrong, else the unit of the speed, or i, r, m of the car"
        )
        yield Finding(RATIO, torque, at, odd)
    elif not found.judged and (weak := next(filter(is_weak, WEAK), None)):
        given = _given("T_mot", f"{split(torque)[0]} [kNm]")
        unit = f"kN.m called N.m ({given})" if weak == WEAK[-1] else "its unit or the side of the gear looks wrong"
        odd = f"gives about 1/{weak:g} of what the motion takes, and follows it otherwise: {unit}"
        yield Finding(RATIO, torque, at, odd)
    elif found.driven > LIVELY and found.with_motor < OWN:
        odd = (
            f"has nothing to do with what drives the car (correlation {found.with_motor:.2f}): it looks like that of "
            "another drive or channel, or is late"
        )
        yield Finding(OTHER, torque, at, odd)


def not_followed(drive: Drive, time: np.ndarray, v: np.ndarray) -> list[Finding]:
    """A recorded speed that a simulated car did not keep.

    Args:
        time: in s from the first sample of the recording on.
        v: of the car without control, in m/s.
    """
    error = v - np.interp(time, drive.time - drive.time[0], drive.v)
    rms = float(np.sqrt(np.mean(error**2)))
    if rms <= FOLLOWED:
        return []
    k = int(np.argmax(np.abs(error)))
    odd = (
        f"is not kept: the simulated car is {error[k]:+.3g} m/s off there and {rms:.2g} m/s rms on the whole; torque, "
        "speed and car do not belong together"
    )
    return [Finding(FOLLOWING, drive.heading("v"), float(drive.time[0] + time[k]), odd)]


def _of(channel: Channel, rule: Rule, at: np.ndarray, odd: str) -> Finding:
    """Samples of a channel, by their indices, of which the first is named."""
    first, times = int(at[0]), _marked(channel.time[at])
    return Finding(rule, channel.heading, float(channel.time[first]), odd, channel.where(first), times)


def _marked(times: np.ndarray) -> tuple[float, ...]:
    few = np.linspace(0, len(times) - 1, min(len(times), MOST_MARKED)).round().astype(int)
    return tuple(times[few].tolist())


def _given(quantity: str, heading: str) -> str:
    """The option that says what a column holds."""
    return f"--column {quantity}={quote(heading)}"


def _more(count: int, what: str = "sample") -> str:
    return "" if count == 1 else f" ({count} {what}s)"
