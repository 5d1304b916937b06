"""What is seen of a case: its runs, and where in them signals are wrong, contradict each other or are beyond limits."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf

import numpy as np

from ...loop import roles
from ...loop.places import T_S
from .fault_cases import Fault
from .fault_injection import Limits, Runs

WITH_WHEEL_SPEED, WITHOUT_WHEEL_SPEED, FALLBACK = 2, 3, 4
"""Status of the controller."""

WRONG_SPEED = 40.0
"""Error of a motor speed in rad/s that has to be noticed, beside SHARE of it."""

RIGHT_SPEED = 20.0
"""Error of the wheel speed in rad/s up to which it shows that the motor speed is wrong."""

MISMATCH, SHARE = 30.0, 0.06
"""What parts motor and wheel speed as no healthy car does: rad/s, and a share of the speed beside it."""

LEAP = 20.0
"""Change of the error in rad/s from one message to the next that shows that it is the messages that are wrong."""

SILENCE = 0.06
"""s without a message; longer than ever between healthy ones."""

REFERENCE_AFTER = 0.06
"""s after which a wheel speed that has become known is a valid reference."""


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
        return self.runs.faulty[roles.STATUS]

    @property
    def begin(self) -> float:
        """The instant before which nothing is wrong."""
        return min(fault.begin for fault in self.faults)

    @property
    def end(self) -> float:
        """The instant from which the signals are right again; inf if they stay wrong or nothing is wrong with them."""
        ends = [fault.end for fault in self.faults if fault.kind.number]
        return max((end if end < self.t[-1] else inf for end in ends), default=inf)

    @property
    def lasts(self) -> bool:
        """Whether a motor signal fails to the end of the run, so that there need be no damping there."""
        return any(fault.end >= self.t[-1] and fault.kind.number and not fault.kind.tolerable for fault in self.faults)


def motor_signal_is_wrong(seen: Evidence) -> np.ndarray:
    """Where it is: no number, a torque beyond all limits, or a speed that a good message contradicts."""
    run = seen.runs.faulty
    speed, torque = run["faults.omega_1_meas"], run["faults.T_mot_est"]
    absurd = ~np.isfinite(speed) | ~(np.abs(torque) <= 2.0 * seen.limits.T_max)
    right = run[roles.MEASURED_MOTOR_SPEED]
    contradicted = np.abs(speed - right) > WRONG_SPEED + SHARE * np.abs(right)
    return absurd | (contradicted & wheel_speed_is_good(seen))


def wheel_speed_is_good(seen: Evidence) -> np.ndarray:
    """Where the controller has for some time had a wheel speed that is valid, right and not old."""
    run = seen.runs.faulty
    right = np.abs(run["faults.omega_2_can"] - run[roles.WHEEL_SPEED]) <= RIGHT_SPEED
    good = run["faults.valid"] & run[roles.BUS_VALID] & right & (unchanged_for(run["faults.counter"]) <= SILENCE)
    return good & (time_since(~good) > REFERENCE_AFTER)


def wheel_speed_is_bad(seen: Evidence) -> np.ndarray:
    """Where it is not valid, no number or old."""
    run = seen.runs.faulty
    absurd = ~run["faults.valid"] | ~np.isfinite(run["faults.omega_2_can"])
    return absurd | (unchanged_for(run["faults.counter"]) > SILENCE)


def signals_part(seen: Evidence) -> np.ndarray:
    """Where a wheel speed that is wrong contradicts a motor speed that is right, and has not leapt away from it.

    It has drifted, or was not valid before: nothing tells which of the two is wrong.
    """
    run = seen.runs.faulty
    wheel = np.abs(run["faults.omega_2_can"])
    wrong = run["faults.valid"] & (np.abs(wheel - np.abs(run[roles.WHEEL_SPEED])) > RIGHT_SPEED)
    error = wheel - np.abs(run[roles.MEASURED_MOTOR_SPEED])
    mismatch = wrong & (np.abs(error) > MISMATCH + SHARE * wheel)
    begins = mismatch & ~_before(mismatch)
    leapt = begins & _before(run["faults.valid"]) & (np.abs(error - _before(error)) > LEAP)
    k = np.arange(len(mismatch))
    began = np.maximum.accumulate(np.where(begins, k, 0))
    return mismatch & ~leapt[began]


def motor_is_too_fast(seen: Evidence) -> np.ndarray:
    """Where the motor turns faster than the controller takes for plausible."""
    return np.abs(seen.runs.faulty[roles.MEASURED_MOTOR_SPEED]) > seen.limits.omega_max


def unchanged_for(x: np.ndarray) -> np.ndarray:
    """For how long x has been what it is, in s."""
    return time_since(np.concatenate(([True], x[1:] != x[:-1])))


def time_since(condition: np.ndarray) -> np.ndarray:
    """Time in s since it held; inf if it has not yet."""
    k = np.arange(len(condition))
    last = np.maximum.accumulate(np.where(condition, k, -1))
    return np.where(last < 0, inf, T_S * (k - last))


def _before(x: np.ndarray) -> np.ndarray:
    """x of the sample before."""
    return np.concatenate((x[:1], x[:-1]))
