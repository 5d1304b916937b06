"""Which of the received motor signals can be used: those that are good, else what is expected in their place.

A motor speed is bad when it is not finite, out of range, jumping (far both from the speed of the last
sample and from what is expected now) or frozen (unchanged for t_frozen while the motor turns); a motor
torque when it is not finite, out of range, or far from what the motor should have (torque_loop). A speed
that is bad for longer than t_bad is followed wherever it is plausible, so that it can prove itself (trust).
"""

from typing import Annotated, Any, NamedTuple

from ..block.declaration import Real
from ..block.operators import clip, is_finite, logical_and, logical_not, logical_or, minimum, where
from . import torque_loop
from .torque_loop import LoopState

STILL = 1.0
"""Motor speed in rad/s below which an unchanging speed is taken for standstill."""


class MonitorState(NamedTuple):
    """State of the signal monitor."""

    omega_1: Annotated[float, Real("rad/s", "motor speed used last")]
    T_mot: Annotated[float, Real("N.m", "torque estimate used last")]
    omega_1_last: Annotated[float, Real("rad/s", "motor speed received last")]
    omega_1_unchanged: Annotated[float, Real("s", "time since that speed changed")]
    loop: LoopState
    bad: Annotated[float, Real("s", "time since the motor signals were good")]


def start(u: Any, p: Any) -> MonitorState:
    omega_1 = speed(u.omega_1_meas, 0.0, p)
    T_mot = where(plausible(u.T_mot_est, 2.0 * p.T_max), u.T_mot_est, 0.0)
    return MonitorState(
        omega_1=omega_1,
        T_mot=T_mot,
        omega_1_last=omega_1,
        omega_1_unchanged=0.0,
        loop=torque_loop.start(T_mot),
        bad=0.0,
    )


def plausible(signal: Any, limit: Any) -> Any:
    """Finite and at most the limit in magnitude."""
    return logical_and(is_finite(signal), abs(signal) <= limit)


def is_torque(T_mot_est: Any, loop: LoopState, p: Any) -> Any:
    """Whether a torque estimate (N.m) is in range, and can be that of what the motor should have."""
    return logical_and(plausible(T_mot_est, 2.0 * p.T_max), torque_loop.agrees(loop, T_mot_est, p))


def torque(T_mot_est: Any, loop: LoopState, p: Any) -> Any:
    """The torque estimate, or what the motor should have where it cannot be that."""
    return where(is_torque(T_mot_est, loop, p), T_mot_est, loop.T_mot)


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
    omega_1, T_mot = speed(u.omega_1_meas, expected, p), torque(u.T_mot_est, x.loop, p)
    near = logical_or(abs(omega_1 - expected) <= p.e_jump, abs(omega_1 - x.omega_1) <= p.e_jump)
    omega_1_unchanged = where(u.omega_1_meas == x.omega_1_last, x.omega_1_unchanged + T_s, 0.0)
    frozen = logical_and(omega_1_unchanged >= p.t_frozen, abs(omega_1) > STILL)
    possible = logical_and(plausible(u.omega_1_meas, p.omega_max), is_torque(u.T_mot_est, x.loop, p))
    good = logical_and(logical_and(possible, near), logical_not(frozen))
    bad = where(good, 0.0, minimum(x.bad + T_s, p.t_bad + T_s))
    return MonitorState(
        omega_1=where(logical_or(near, bad > p.t_bad), omega_1, expected),
        T_mot=T_mot,
        omega_1_last=where(is_finite(u.omega_1_meas), u.omega_1_meas, 0.0),
        omega_1_unchanged=minimum(omega_1_unchanged, p.t_frozen),
        loop=torque_loop.update(x.loop, T_ref, T_s, p),
        bad=bad,
    )
