"""Whether a run under faults is clean: judges, each a number with a limit.

A judge sees the evidence of one case and gives a number; the case is clean if none is above its limit. The times and
shares behind the limits are those of the requirements: a wrong signal is noticed within 50 ms, everything is as before
within 0.5 s, and the drive train never swings 1.2 times as much as without control. The limits on torques are for the
default car; those of another car are multiplied by 180 N.m/T_max before they are judged.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import inf

import numpy as np

from ....fmus.names import T_MAX
from ...loop import roles
from ...loop.places import T_S
from ...metrics.oscillation import amplitude
from ...metrics.spectrum import band_rms
from .evidence import (
    FALLBACK,
    WITH_WHEEL_SPEED,
    WITHOUT_WHEEL_SPEED,
    Evidence,
    motor_is_too_fast,
    motor_signal_is_wrong,
    signals_part,
    time_since,
    unchanged_for,
    wheel_speed_is_bad,
)
from .fault_catalogue import WHEEL_SPEED

NOTICED, STALE, BACK = 0.05, 0.15, 0.5
"""Times in s: to notice a wrong motor signal; to notice that no message comes; to be as before."""

NEAR = 0.05
"""Time in s by which teeth that have swung otherwise may meet earlier or later."""

LEAST_RMS, LEAST_SWING = 1.0, 5.0
"""What the gear torque may always swing, N.m: rms and amplitude."""

OF_DEFAULT = f" (times {T_MAX:g} N.m/T_max)"
"""Said of torques that are judged as those of the default car."""


@dataclass(frozen=True)
class Judge:
    """One question about a run, answered by a number that must not be above the limit.

    Attributes:
        of_status: whether it is about the status, so that it finds nothing where a controller tells none.
    """

    name: str
    unit: str
    limit: float
    question: str
    measure: Callable[[Evidence], float]
    of_status: bool = False


def excess_of_T_ref(seen: Evidence) -> float:
    """By how much T_ref is beyond T_max, N.m; inf if it is not finite."""
    T_ref = seen.runs.faulty[roles.REFERENCE_TORQUE]
    return float(np.abs(T_ref).max()) - seen.limits.T_max if np.isfinite(T_ref).all() else inf


def excess_of_T_damp(seen: Evidence) -> float:
    """By how much what the controller adds in the direction of the demand is beyond T_add_max, or against it beyond
    T_take_max, N.m."""
    T_damp, T_driver = seen.runs.faulty[roles.DAMPING_TORQUE][1:], seen.runs.faulty[roles.DEMAND][:-1]
    taken = np.where(T_damp * T_driver < 0.0, seen.limits.T_take_max, seen.limits.T_add_max)
    return float((np.abs(T_damp) - taken).max())


def time_blind(seen: Evidence) -> float:
    """Longest time in s after which a wrong motor signal is still used; 0 if none is wrong."""
    damping = (seen.status == WITH_WHEEL_SPEED) | (seen.status == WITHOUT_WHEEL_SPEED)
    return _longest_lag(motor_signal_is_wrong(seen), damping)


def time_deaf(seen: Evidence) -> float:
    """Longest time in s after which bad messages still count as wheel speed; 0 if all are good."""
    return _longest_lag(wheel_speed_is_bad(seen), seen.status == WITH_WHEEL_SPEED)


def time_of_false_alarm(seen: Evidence) -> float:
    """Time in s in fallback that nothing calls for, nor did in the last 0.5 s: no fault of a motor signal but one to be
    tolerated, no wheel speed that parts from the motor speed unnoticed, no motor that turns too fast."""
    called_for = signals_part(seen) | motor_is_too_fast(seen)
    for fault in seen.faults:
        if fault.kind.signal != WHEEL_SPEED and not fault.kind.tolerable:
            called_for |= (seen.t >= fault.begin) & (seen.t < fault.end)
    alarm = (seen.status == FALLBACK) & (time_since(called_for) > BACK + 0.5 * T_S)
    return T_S * float(alarm.sum())


def time_to_return(seen: Evidence) -> float:
    """Time in s from the end of the faults until the status is that of a healthy controller for good.

    What is valid in one sample is answered in the next. A motor that turns too fast is not the fault's doing.
    """
    if seen.end == inf:
        return 0.0
    healthy, valid = seen.runs.healthy[roles.STATUS], seen.runs.faulty[roles.BUS_VALID]
    lacks_wheel = (seen.status == WITHOUT_WHEEL_SPEED) & (healthy == WITH_WHEEL_SPEED)
    lacks_wheel[1:] &= valid[1:] & valid[:-1]
    falls_back = (seen.status == FALLBACK) & (time_since(motor_is_too_fast(seen)) > BACK)
    other = np.flatnonzero((falls_back | lacks_wheel) & (seen.t >= seen.end))
    return float(seen.t[other[-1]]) + T_S - seen.end if len(other) else 0.0


def kick(seen: Evidence) -> float:
    """Largest torque in N.m that the controller adds once it is back, beyond what lies between nothing and what it adds
    within NEAR of that instant without the fault, less by how much the gear torque differs from that run in the 0.2 s
    before; as of the motor of the default car."""
    if seen.end == inf:
        return 0.0
    fell = np.flatnonzero((seen.status == FALLBACK) & (seen.t >= seen.end))
    since = seen.t[fell[-1]] if len(fell) else seen.end + BACK
    added, usual = (run[roles.DAMPING_TORQUE] for run in (seen.runs.faulty, seen.runs.healthy))
    beyond = np.abs(added - np.clip(added, -_largest_near(-usual), _largest_near(usual)))
    swing = np.abs(seen.runs.faulty[roles.GEAR_TORQUE] - seen.runs.healthy[roles.GEAR_TORQUE])
    excess = beyond - _largest_before(swing, round(0.2 / T_S))
    return float(excess[seen.t > since].max(initial=0.0)) / seen.limits.share


def swing_left(seen: Evidence) -> float:
    """Amplitude in N.m of the gear torque in the last 0.5 s, less that without the fault; if a motor signal is still
    wrong there, less that without control where this is larger; as of the motor of the default car."""
    last = round(0.5 / T_S)
    left, usual, undamped = (amplitude(run[roles.GEAR_TORQUE][-last:], T_S).max() for run in seen.runs)
    return float(left - (max(usual, undamped) if seen.lasts else usual)) / seen.limits.share


def ratio_of_rms(seen: Evidence) -> float:
    """Gear torque from 5 to 50 Hz from the fault on, over that without control."""
    later = seen.t >= seen.begin - 0.1
    with_fault, undamped = (
        band_rms(run[roles.GEAR_TORQUE][later], T_S) for run in (seen.runs.faulty, seen.runs.undamped)
    )
    return with_fault / max(undamped, LEAST_RMS * seen.limits.share)


def ratio_of_swing(seen: Evidence) -> float:
    """Largest amplitude of the gear torque from the fault on, over that without control, or over that without the
    fault where this is larger."""
    later = seen.t >= seen.begin
    with_fault, without, undamped = (amplitude(run[roles.GEAR_TORQUE][later], T_S).max() for run in seen.runs)
    return float(with_fault) / max(float(undamped), float(without), LEAST_SWING * seen.limits.share)


def _longest_lag(wrong: np.ndarray, believed: np.ndarray) -> float:
    """Longest time in s from the beginning of a stretch that is wrong to where it is still believed."""
    return float(np.where(wrong & believed, unchanged_for(wrong) + T_S, 0.0).max())


def _largest_before(x: np.ndarray, samples: int) -> np.ndarray:
    """The largest of x among this many samples up to each."""
    padded = np.concatenate((np.full(samples - 1, x[0]), x))
    return np.lib.stride_tricks.sliding_window_view(padded, samples).max(axis=1)


def _largest_near(x: np.ndarray) -> np.ndarray:
    """The largest of x and 0 within NEAR of each sample."""
    samples = round(NEAR / T_S)
    padded = np.pad(x, samples)
    return np.lib.stride_tricks.sliding_window_view(padded, 2 * samples + 1).max(axis=1).clip(0.0)


JUDGES = (
    Judge("limited", "N.m", 1e-9, "T_ref beyond T_max (inf: not finite)", excess_of_T_ref),
    Judge("authority", "N.m", 1e-9, "torque added beyond T_add_max, or taken beyond T_take_max", excess_of_T_damp),
    Judge("noticed", "s", NOTICED + 1e-9, "time for which a wrong motor signal is used", time_blind, of_status=True),
    Judge("stale", "s", STALE + 1e-9, "time for which a bad message counts as wheel speed", time_deaf, of_status=True),
    Judge("false alarm", "s", 1e-9, "time in fallback that no fault calls for", time_of_false_alarm, of_status=True),
    Judge("back", "s", BACK + 1e-9, "time until everything is as before", time_to_return, of_status=True),
    Judge("kick", "N.m", 2.0, f"torque added after that which the swing does not call for{OF_DEFAULT}", kick),
    Judge("settled", "N.m", 5.0, f"swing that is left at the end{OF_DEFAULT}", swing_left),
    Judge("rms", "1", 1.2, "gear torque 5-50 Hz over that without control", ratio_of_rms),
    Judge("swing", "1", 1.2, "largest swing over that without control, or without the fault", ratio_of_swing),
)
