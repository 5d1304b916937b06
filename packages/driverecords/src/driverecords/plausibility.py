"""Whether a recorded drive can be true. Each rule looks for one thing that files have in spite of being well-formed,
and gives at most one finding a channel: column, time, and what is odd. Nothing is refused.
"""

from collections.abc import Iterator
from math import inf, pi
from shlex import quote

import numpy as np

from .channel_rules import RULES as CHANNEL_RULES
from .channel_rules import of_channels
from .drive import Drive
from .findings import Finding, Rule, marked
from .force_balance import FORCE, LARGEST, SIGNED, SMALLEST, TOGETHER, Car, balance, forces
from .headings import split
from .thresholds import Threshold
from .time_base import interval_of

OSCILLATION = 8.0
"""Frequency of a drive train in Hz."""

SLOWEST = Threshold(
    0.2, "s", "longest interval of a demand", "a ramp of that length leaves 20 % of the swing after a step, at 8 Hz"
)
BEYOND = Threshold(0.01, "1", "share of the samples that may lie beyond T_max", "0.1 % in trip a11, T_max 180 N.m")
UNABLE = Threshold(
    1.5, "1", "torque over T_max beyond which not even one may lie", "1.26 in trip a11, whose motor has 250 N.m"
)
SHORTEST = Threshold(
    2e-4, "s", "interval of the fastest recordings; in ms, none faster is tried", "loggers reach 5 kHz"
)
LIVELY = Threshold(
    600.0, "N", "standard deviation of what drives a car", "a road that rises and falls by 5 % takes as much"
)
OWN = Threshold(
    0.3, "1", "its correlation with what the motor gives", "0.92 and more in the recorded trips; 0.3 on a road of 14 %"
)
FOLLOWED = Threshold(
    0.3, "m/s", "speed error, rms, of a drive that is followed", "0.56 km/h at most in 200 simulated drives"
)

QUICKEST = Threshold(30.0, "m/s2", "change of speed over all of a recording", "tyres of race cars hold 3 g with wings")

KMH, MS, WEAK = 3.6, 1e-3, (4.0, 16.0, 64.0, 256.0, 1000.0)
"""Factors on speed, time and torque that are tried. Those on a torque that never reaches FORCE leave no ratio out."""

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
    f"more than {BEYOND:.0%} of the samples beyond `motor.T_max`, or one beyond {UNABLE:g} times as much",
    f"{BEYOND.source}; {UNABLE.source}",
)
SIGN = Rule(
    "sign of torque",
    "motor torque that pushes when the car slows down, and the reverse",
    f"correlation of the forces below {-SIGNED:g}",
    SIGNED.source,
)
RATIO = Rule(
    "ratio of torque",
    "a motion that takes another force than the motor gives: wrong unit, side of the gear, car",
    f"below {SMALLEST:g} or above {LARGEST:g}, correlation {TOGETHER:g} and more",
    LARGEST.source,
)
OTHER = Rule(
    "other torque",
    "motor torque that has nothing to do with what drives the car: of another drive or channel, or late",
    f"correlation below {OWN:g} where {LIVELY:g} N (standard deviation) and more drive it",
    OWN.source,
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
FAST_TIME = Rule(
    "time too short",
    "s called ms, or days called s: the car gains or loses speed faster than tyres can",
    f"more than {QUICKEST:g} m/s2 from the least to the largest speed, over the whole recording",
    QUICKEST.source,
)
FOLLOWING = Rule(
    "following",
    "after the drive: a recorded speed that the simulated car does not keep",
    f"{KMH * FOLLOWED:.2g} km/h rms without damping",
    f"the force along the road is corrected until 0.36 km/h are reached; {FOLLOWED.source}",
)

RULES = (*CHANNEL_RULES, RATE, CAPPED, SIGN, RATIO, OTHER, FAST, SLOW_TIME, FAST_TIME, FOLLOWING)
"""All that is looked for."""


def of_drive(drive: Drive, car: Car | None = None, T_max: float = inf) -> list[Finding]:
    """What is odd in a drive that a car is to follow. Its rate is not judged where its times are wrong.

    Args:
        car: whose motion it is; None: not known, so that the balance of its forces is not looked at.
        T_max: largest torque of its motor in N.m.
    """
    motion = list(too_short(drive)) or (list(unbalanced(drive, car)) if car else [])
    # ms called s are a slow rate as well, whose line stood before the one that explains it
    rate = [] if any(finding.rule in (SLOW_TIME, FAST_TIME) for finding in motion) else slow_sampling(drive)
    return [*of_channels(drive.channels.values()), *rate, *beyond_T_max(drive, T_max), *motion]


def too_short(drive: Drive) -> Iterator[Finding]:
    """Times in which no car changes its speed so much."""
    lasts, change = float(np.ptp(drive.time)), float(np.ptp(drive.v))
    if change > QUICKEST * lasts:
        odd = f"lasts {lasts:.3g} s, in which the speed changes by {change:.3g} m/s: its unit looks wrong"
        yield Finding(FAST_TIME, drive.clock, float(drive.time[0]), odd)


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
    """Torques that are cut off, or none of this motor."""
    torque = np.abs(drive.T_mot)
    beyond, unable = torque > T_max, torque > UNABLE * T_max
    if beyond.mean() > BEYOND or unable.any():
        often = beyond.mean() > BEYOND
        at = np.flatnonzero(beyond if often else unable)
        k = int(np.argmax(torque)) if often else int(at[0])
        share = f"{beyond.mean():.1%} of the samples lie" if often else f"{len(at)} of {len(torque)} samples lie far"
        yield Finding(
            CAPPED,
            drive.heading("T_mot"),
            float(drive.time[k]),
            f"is {drive.T_mot[k]:.4g} N.m; {share} beyond T_max = {T_max:g} N.m of the motor and are cut off there "
            "(--set motor.T_max=...)",
            samples=marked(drive.time[at]),
        )


def unbalanced(drive: Drive, car: Car) -> Iterator[Finding]:
    """A motion that is not that of this torque and this car: one finding, of what explains it best."""

    def fits(time: float = 1.0, v: float = 1.0) -> bool:
        return balance(forces(time * drive.time, v * drive.v, drive.T_mot, car)).fits

    def is_weak(factor: float) -> bool:
        weak = balance(along, factor)
        return weak.fits and weak.moved > FORCE

    along = forces(drive.time, drive.v, drive.T_mot, car)
    result, torque = balance(along), drive.heading("T_mot")
    at = result.worst
    if result.correlation < -SIGNED:
        odd = (
            f"pushes when the car slows down, and the reverse (correlation {result.correlation:.2f}): its sign looks "
            f"wrong; {_column_option('T_mot', f'-{torque}')} turns it"
        )
        yield Finding(SIGN, torque, at, odd)
    # in ms the Gaussian would go over a million samples: 10 min at 1 kHz would take half an hour
    elif result.judged and result.together < TOGETHER and MS * interval_of(drive.time) >= SHORTEST and fits(time=MS):
        clock = drive.clock
        odd = (
            f"goes on by {interval_of(drive.time):.4g} s a sample, and motion and torque fit if that is ms: its unit "
            f"looks wrong; {_column_option('time', f'{split(clock)[0]} [ms]')} gives it"
        )
        yield Finding(SLOW_TIME, clock, float(drive.time[0]), odd)
    elif result.judged and result.together >= TOGETHER and result.ratio > LARGEST and fits(v=1.0 / KMH):
        speed = drive.heading("v")
        odd = (
            f"changes as if the motor had {result.ratio:.2g} times its torque, and fits if it is {KMH:g} times too "
            f"large, km/h called m/s ({_column_option('v', f'{split(speed)[0]} [km/h]')}); else torque, i, r or m are "
            "wrong"
        )
        yield Finding(FAST, speed, at, odd)
    elif result.judged and result.together >= TOGETHER and not result.fits:
        odd = (
            f"gives {1.0 / result.ratio:.2g} times what the motion takes (correlation {result.together:.2f}): its unit "
            "or the side of the gear looks wrong, else the unit of the speed, or i, r, m of the car"
        )
        yield Finding(RATIO, torque, at, odd)
    elif not result.judged and (weak := next(filter(is_weak, WEAK), None)):
        option = _column_option("T_mot", f"{split(torque)[0]} [kNm]")
        unit = f"kN.m called N.m ({option})" if weak == WEAK[-1] else "its unit or the side of the gear looks wrong"
        odd = f"gives about 1/{weak:g} of what the motion takes, and follows it otherwise: {unit}"
        yield Finding(RATIO, torque, at, odd)
    elif result.driven > LIVELY and result.with_motor < OWN:
        odd = (
            f"has nothing to do with what drives the car (correlation {result.with_motor:.2f}): it looks like that of "
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
        f"is not kept: the simulated car is {KMH * error[k]:+.3g} km/h off there and {KMH * rms:.2g} km/h rms on the "
        "whole; torque, speed and car do not belong together"
    )
    return [Finding(FOLLOWING, drive.heading("v"), float(drive.time[0] + time[k]), odd)]


def _column_option(quantity: str, heading: str) -> str:
    """The option that says what a column holds."""
    return f"--column {quantity}={quote(heading)}"
