"""Whether a run under faults is clean: judges, each a number with a limit.

A judge sees the evidence of one case and gives a number; the case is clean if none is above its limit. The times and
shares behind the limits are those of the requirements: a wrong signal is noticed within 50 ms, everything is as before
within 0.5 s, and the drive train never swings 1.2 times as much as without control.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import inf

import numpy as np

from ..metrics.evaluate import T_S
from ..metrics.oscillation import amplitude
from ..metrics.spectrum import band_rms
from .bench import Limits, Runs
from .cases import DURATION, Fault
from .catalogue import MOTOR_SPEED, MOTOR_TORQUE

WITH_WHEEL_SPEED, WITHOUT_WHEEL_SPEED, FALLBACK = 2, 3, 4
"""Status of the controller."""

WRONG_SPEED = 40.0
"""Error of a speed in rad/s that has to be noticed."""

RIGHT_SPEED = 20.0
"""Error of the wheel speed in rad/s up to which it shows that the motor speed is wrong."""

SILENCE = 0.06
"""s without a message; longer than ever between healthy ones."""

NOTICED, STALE, BACK = 0.05, 0.15, 0.5
"""Times in s: to notice a wrong motor signal; to notice that no message comes; to be as before."""

LEAST_RMS, LEAST_SWING = 1.0, 5.0
"""What the gear torque may always swing, N.m: rms and amplitude."""


@dataclass(frozen=True)
class Evidence:
    """What the judges see.

    Attributes:
        runs: at the samples of the controller.
        faults: of the case.
        limits: of the controller.
    """

    runs: Runs
    faults: Sequence[Fault]
    limits: Limits

    @property
    def t(self) -> np.ndarray:
        return self.runs.faulty["time"]

    @property
    def status(self) -> np.ndarray:
        return self.runs.faulty["controller.status"]

    @property
    def begin(self) -> float:
        """The instant before which nothing is wrong."""
        return min(fault.begin for fault in self.faults)

    @property
    def end(self) -> float:
        """The instant from which the signals are right again; inf if they stay wrong or nothing is wrong with them."""
        return max(
            (fault.end if fault.end < DURATION else inf for fault in self.faults if fault.kind.number), default=inf
        )


@dataclass(frozen=True)
class Judge:
    """One question about a run, answered by a number that must not be above the limit."""

    name: str
    unit: str
    limit: float
    question: str
    measure: Callable[[Evidence], float]


def excess_of_T_ref(seen: Evidence) -> float:
    """By how much T_ref is beyond T_max, N.m; inf if it is not finite."""
    T_ref = seen.runs.faulty["controller.T_ref"]
    return float(np.abs(T_ref).max()) - seen.limits.T_max if np.isfinite(T_ref).all() else inf


def excess_of_T_damp(seen: Evidence) -> float:
    """By how much what the controller adds in the direction of the demand is beyond T_add_max, or against it beyond
    T_take_max, N.m."""
    T_damp, T_driver = seen.runs.faulty["controller.T_damp"][1:], seen.runs.faulty["controller.T_driver"][:-1]
    taken = np.where(T_damp * T_driver < 0.0, seen.limits.T_take_max, seen.limits.T_add_max)
    return float((np.abs(T_damp) - taken).max())


def time_blind(seen: Evidence) -> float:
    """Longest time in s after which a wrong motor signal is still used; 0 if none is wrong."""
    damping = (seen.status == WITH_WHEEL_SPEED) | (seen.status == WITHOUT_WHEEL_SPEED)
    return _longest_lag(motor_signal_is_wrong(seen), damping)


def motor_signal_is_wrong(seen: Evidence) -> np.ndarray:
    """Where it is: no number, a torque beyond all limits, or a speed that a good message contradicts."""
    run = seen.runs.faulty
    speed, torque = run["faults.omega_1_meas"], run["faults.T_mot_est"]
    absurd = ~np.isfinite(speed) | ~(np.abs(torque) <= 2.0 * seen.limits.T_max)
    contradicted = np.abs(speed - run["motor.omega_1_meas"]) > WRONG_SPEED
    return absurd | (contradicted & message_is_good(seen))


def message_is_good(seen: Evidence) -> np.ndarray:
    """Where the controller has a wheel speed that is valid, right and not old."""
    run = seen.runs.faulty
    right = np.abs(run["faults.omega_2_can"] - run["plant.omega_2"]) <= RIGHT_SPEED
    return run["faults.valid"] & run["can.valid"] & right & (_unchanged_for(run["faults.counter"]) <= SILENCE)


def time_deaf(seen: Evidence) -> float:
    """Longest time in s after which bad messages still count as wheel speed; 0 if all are good."""
    run = seen.runs.faulty
    speed = run["faults.omega_2_can"]
    absurd = ~run["faults.valid"] | ~np.isfinite(speed) | (_unchanged_for(run["faults.counter"]) > SILENCE)
    return _longest_lag(absurd, seen.status == WITH_WHEEL_SPEED)


def time_of_false_alarm(seen: Evidence) -> float:
    """Time in s in fallback without a fault of a motor signal now or in the last 0.5 s, or for one to be tolerated."""
    alarm = seen.status == FALLBACK
    for fault in seen.faults:
        if fault.kind.signal in (MOTOR_SPEED, MOTOR_TORQUE) and not fault.kind.tolerable:
            alarm &= ~((seen.t >= fault.begin) & (seen.t < fault.end + BACK))
    return T_S * float(alarm.sum())


def time_to_return(seen: Evidence) -> float:
    """Time in s from the end of the faults until the status is that of a healthy controller for good."""
    if seen.end == inf:
        return 0.0
    healthy = seen.runs.healthy["controller.status"]
    lacks_wheel = (seen.status == WITHOUT_WHEEL_SPEED) & (healthy == WITH_WHEEL_SPEED) & seen.runs.faulty["can.valid"]
    other = np.flatnonzero(((seen.status == FALLBACK) | lacks_wheel) & (seen.t >= seen.end))
    return float(seen.t[other[-1]]) + T_S - seen.end if len(other) else 0.0


def kick(seen: Evidence) -> float:
    """Largest torque in N.m that the controller adds once it is back, less what it adds without the fault and less by
    how much the gear torque differs from that run in the 0.2 s before."""
    if seen.end == inf:
        return 0.0
    fell = np.flatnonzero((seen.status == FALLBACK) & (seen.t >= seen.end))
    since = seen.t[fell[-1]] if len(fell) else seen.end + BACK
    other = np.abs(_difference(seen, "controller.T_damp"))
    swing = np.abs(_difference(seen, "plant.T_gear"))
    excess = other - _largest_before(swing, round(0.2 / T_S))
    return float(excess[seen.t > since].max(initial=0.0))


def swing_left(seen: Evidence) -> float:
    """Amplitude in N.m of the gear torque in the last 0.5 s, less that without the fault."""
    last = round(0.5 / T_S)
    left, usual = (amplitude(run["plant.T_gear"][-last:], T_S).max() for run in (seen.runs.faulty, seen.runs.healthy))
    return float(left - usual)


def ratio_of_rms(seen: Evidence) -> float:
    """Gear torque from 5 to 50 Hz from the fault on, over that without control."""
    later = seen.t >= seen.begin - 0.1
    with_fault, undamped = (band_rms(run["plant.T_gear"][later], T_S) for run in (seen.runs.faulty, seen.runs.undamped))
    return with_fault / max(undamped, LEAST_RMS)


def ratio_of_swing(seen: Evidence) -> float:
    """Largest amplitude of the gear torque from the fault on, over that without control, or over that without the
    fault where this is larger."""
    later = seen.t >= seen.begin
    with_fault, without, undamped = (amplitude(run["plant.T_gear"][later], T_S).max() for run in seen.runs)
    return float(with_fault) / max(float(undamped), float(without), LEAST_SWING)


def _difference(seen: Evidence, column: str) -> np.ndarray:
    return seen.runs.faulty[column] - seen.runs.healthy[column]


def _unchanged_for(x: np.ndarray) -> np.ndarray:
    """For how long x has been what it is, in s."""
    k = np.arange(len(x))
    changed = np.concatenate(([True], x[1:] != x[:-1]))
    return T_S * (k - np.maximum.accumulate(np.where(changed, k, 0)))


def _longest_lag(wrong: np.ndarray, believed: np.ndarray) -> float:
    """Longest time in s from the beginning of a stretch that is wrong to where it is still believed."""
    return float(np.where(wrong & believed, _unchanged_for(wrong) + T_S, 0.0).max())


def _largest_before(x: np.ndarray, samples: int) -> np.ndarray:
    """The largest of x among this many samples up to each."""
    padded = np.concatenate((np.full(samples - 1, x[0]), x))
    return np.lib.stride_tricks.sliding_window_view(padded, samples).max(axis=1)


JUDGES = (
    Judge("limited", "N.m", 1e-9, "T_ref beyond T_max (inf: not finite)", excess_of_T_ref),
    Judge("authority", "N.m", 1e-9, "torque added beyond T_add_max, or taken beyond T_take_max", excess_of_T_damp),
    Judge("noticed", "s", NOTICED + 1e-9, "time for which a wrong motor signal is used", time_blind),
    Judge("stale", "s", STALE + 1e-9, "time for which a bad message counts as wheel speed", time_deaf),
    Judge("false alarm", "s", 1e-9, "time in fallback that no fault calls for", time_of_false_alarm),
    Judge("back", "s", BACK + 1e-9, "time until everything is as before", time_to_return),
    Judge("kick", "N.m", 2.0, "torque added after that which the swing does not call for", kick),
    Judge("settled", "N.m", 5.0, "swing that is left at the end", swing_left),
    Judge("rms", "1", 1.2, "gear torque 5-50 Hz over that without control", ratio_of_rms),
    Judge("swing", "1", 1.2, "largest swing over that without control, or without the fault", ratio_of_swing),
)
