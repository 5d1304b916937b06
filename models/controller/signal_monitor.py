"""What the controller makes of the signals of motor control: used where they are good, else bridged.

A speed is bad when it is not finite, out of range, far from the estimate, or frozen (unchanged for
t_frozen while the motor turns); a torque when it is not finite, out of range, or frozen (unchanged for
t_frozen, yet not what is demanded; it then stays frozen until it changes).
"""

from typing import Any, NamedTuple

from ..block.operators import is_finite, logical_and, logical_not, logical_or, minimum, where

STILL = 1.0
"""Motor speed in rad/s below which an unchanging speed is taken for standstill."""

OBEYED = 10.0
"""Distance in N.m from the demand within which an unchanging torque is taken for the demanded one."""


class MotorSignals(NamedTuple):
    """Speed (rad/s) and torque (N.m) to be used, whether both are good, and for how long (s) the
    received ones have not changed (2 t_frozen for a torque that has been found frozen)."""

    omega_1: Any
    T_mot: Any
    good: Any
    omega_1_unchanged: Any
    T_mot_unchanged: Any


def plausible(signal: Any, limit: Any) -> Any:
    """Finite and at most the limit in magnitude."""
    return logical_and(is_finite(signal), abs(signal) <= limit)


def torque(T_mot_est: Any, last: Any, p: Any) -> Any:
    """The torque estimate, or the last one where it is out of range."""
    return where(plausible(T_mot_est, 2.0 * p.T_max), T_mot_est, last)


def speed(omega_1_meas: Any, omega_1_hat: Any, p: Any) -> Any:
    """The measured speed, or the estimated one where it is out of range."""
    return where(plausible(omega_1_meas, p.omega_max), omega_1_meas, omega_1_hat)


def judged(x: Any, u: Any, omega_1_hat: Any, T_s: float, p: Any) -> MotorSignals:
    """The signals of one sample.

    Args:
        x: state with omega_1_last, T_mot_last, omega_1_unchanged, T_mot_unchanged, T_mot and T_ref.
        u: input with omega_1_meas and T_mot_est.
        omega_1_hat: estimate of the speed at this sample.
    """
    omega_1, T_mot = speed(u.omega_1_meas, omega_1_hat, p), torque(u.T_mot_est, x.T_mot, p)
    near = abs(omega_1 - omega_1_hat) <= p.e_max
    omega_1_unchanged = where(u.omega_1_meas == x.omega_1_last, x.omega_1_unchanged + T_s, 0.0)
    T_mot_unchanged = where(u.T_mot_est == x.T_mot_last, x.T_mot_unchanged + T_s, 0.0)
    omega_1_frozen = logical_and(omega_1_unchanged >= p.t_frozen, abs(omega_1) > STILL)
    disobeyed = logical_or(abs(T_mot - x.T_ref) > OBEYED, T_mot_unchanged > 1.5 * p.t_frozen)
    T_mot_frozen = logical_and(T_mot_unchanged >= p.t_frozen, disobeyed)
    in_range = logical_and(plausible(u.omega_1_meas, p.omega_max), plausible(u.T_mot_est, 2.0 * p.T_max))
    alive = logical_not(logical_or(omega_1_frozen, T_mot_frozen))
    return MotorSignals(
        omega_1=where(near, omega_1, omega_1_hat),
        T_mot=T_mot,
        good=logical_and(logical_and(in_range, near), alive),
        omega_1_unchanged=minimum(omega_1_unchanged, p.t_frozen),
        T_mot_unchanged=where(T_mot_frozen, 2.0 * p.t_frozen, minimum(T_mot_unchanged, p.t_frozen)),
    )
