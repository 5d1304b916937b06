"""Which of the received motor signals can be used: those that are good, else what is expected in their place.

A motor speed is bad when it is not finite, out of range, jumping (far both from the speed of the last
sample and from what is expected now) or frozen (unchanged for t_frozen while the motor turns); a motor
torque when it is not finite, out of range, or frozen (unchanged for t_frozen, yet not what is demanded; it
then stays frozen until it changes). A speed that is bad for longer than t_bad is followed wherever it is
plausible, so that it can prove itself (trust).
"""

from typing import Annotated, Any, NamedTuple

from ..block.declaration import Boolean, Real
from ..block.operators import clip, is_finite, logical_and, logical_not, logical_or, minimum, where

STILL = 1.0
"""Motor speed in rad/s below which an unchanging speed is taken for standstill."""

OBEYED = 10.0
"""Distance in N.m from the demand within which an unchanging torque is taken for the demanded one."""


class MonitorState(NamedTuple):
    """State of the signal monitor."""

    omega_1: Annotated[float, Real("rad/s", "motor speed used last")]
    T_mot: Annotated[float, Real("N.m", "torque estimate used last")]
    omega_1_last: Annotated[float, Real("rad/s", "motor speed received last")]
    T_mot_last: Annotated[float, Real("N.m", "torque estimate received last")]
    omega_1_unchanged: Annotated[float, Real("s", "time since that speed changed")]
    T_mot_unchanged: Annotated[float, Real("s", "time since that torque changed")]
    T_mot_frozen: Annotated[bool, Boolean("that torque was found frozen")]
    bad: Annotated[float, Real("s", "time since the motor signals were good")]


def start(u: Any, p: Any) -> MonitorState:
    omega_1, T_mot = speed(u.omega_1_meas, 0.0, p), torque(u.T_mot_est, 0.0, p)
    return MonitorState(
        omega_1=omega_1,
        T_mot=T_mot,
        omega_1_last=omega_1,
        T_mot_last=T_mot,
        omega_1_unchanged=0.0,
        T_mot_unchanged=0.0,
        T_mot_frozen=False,
        bad=0.0,
    )


def plausible(signal: Any, limit: Any) -> Any:
    """Finite and at most the limit in magnitude."""
    return logical_and(is_finite(signal), abs(signal) <= limit)


def torque(T_mot_est: Any, last: Any, p: Any) -> Any:
    """The torque estimate, or the last one where it is out of range."""
    return where(plausible(T_mot_est, 2.0 * p.T_max), T_mot_est, last)


def speed(omega_1_meas: Any, expected: Any, p: Any) -> Any:
    """The measured speed, or the expected one where it is out of range."""
    return where(plausible(omega_1_meas, p.omega_max), omega_1_meas, expected)


def update(x: MonitorState, u: Any, increment: Any, T_ref: Any, T_s: Any, p: Any) -> MonitorState:
    """The state after the signals of one sample.

    Args:
        u: input with omega_1_meas, T_mot_est.
        increment: by which the motor speed should have changed since the last sample, rad/s.
        T_ref: demand that the motor has, N.m.
    """
    expected = clip(x.omega_1 + increment, -p.omega_max, p.omega_max)
    omega_1, T_mot = speed(u.omega_1_meas, expected, p), torque(u.T_mot_est, x.T_mot, p)
    near = logical_or(abs(omega_1 - expected) <= p.e_jump, abs(omega_1 - x.omega_1) <= p.e_jump)
    omega_1_unchanged = where(u.omega_1_meas == x.omega_1_last, x.omega_1_unchanged + T_s, 0.0)
    T_mot_unchanged = where(u.T_mot_est == x.T_mot_last, x.T_mot_unchanged + T_s, 0.0)
    omega_1_frozen = logical_and(omega_1_unchanged >= p.t_frozen, abs(omega_1) > STILL)
    disobeyed = logical_or(abs(T_mot - T_ref) > OBEYED, x.T_mot_frozen)
    T_mot_frozen = logical_and(T_mot_unchanged >= p.t_frozen, disobeyed)
    in_range = logical_and(plausible(u.omega_1_meas, p.omega_max), plausible(u.T_mot_est, 2.0 * p.T_max))
    alive = logical_not(logical_or(omega_1_frozen, T_mot_frozen))
    good = logical_and(logical_and(in_range, near), alive)
    bad = where(good, 0.0, minimum(x.bad + T_s, p.t_bad + T_s))
    return MonitorState(
        omega_1=where(logical_or(near, bad > p.t_bad), omega_1, expected),
        T_mot=T_mot,
        omega_1_last=where(is_finite(u.omega_1_meas), u.omega_1_meas, 0.0),
        T_mot_last=where(is_finite(u.T_mot_est), u.T_mot_est, 0.0),
        omega_1_unchanged=minimum(omega_1_unchanged, p.t_frozen),
        T_mot_unchanged=minimum(T_mot_unchanged, p.t_frozen),
        T_mot_frozen=T_mot_frozen,
        bad=bad,
    )
