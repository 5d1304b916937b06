"""Which of the received signals can be used: those that are good, else what bridges them.

A motor speed is bad when it is not finite, out of range, far from the estimate, or frozen (unchanged for
t_frozen while the motor turns); a motor torque when it is not finite, out of range, or frozen (unchanged
for t_frozen, yet not what is demanded; it then stays frozen until it changes). If that lasts longer than
t_bad, the motor signals are not trusted. A message with the wheel speed is used when it is new, valid,
finite, in range and near the estimate; the wheel speed counts as known while such messages keep coming.
"""

from typing import Annotated, Any, NamedTuple

from ..block.declaration import Boolean, Real
from ..block.operators import is_finite, logical_and, logical_not, logical_or, minimum, where

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
    counter: Annotated[float, Real("1", "counter of the message received last")]
    silence: Annotated[float, Real("s", "time since a usable message")]


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
        counter=1.0 * u.counter,
        silence=where(has_wheel_speed(u, p), 0.0, p.t_stale),
    )


def plausible(signal: Any, limit: Any) -> Any:
    """Finite and at most the limit in magnitude."""
    return logical_and(is_finite(signal), abs(signal) <= limit)


def torque(T_mot_est: Any, last: Any, p: Any) -> Any:
    """The torque estimate, or the last one where it is out of range."""
    return where(plausible(T_mot_est, 2.0 * p.T_max), T_mot_est, last)


def speed(omega_1_meas: Any, omega_1_hat: Any, p: Any) -> Any:
    """The measured speed, or the estimated one where it is out of range."""
    return where(plausible(omega_1_meas, p.omega_max), omega_1_meas, omega_1_hat)


def near_speed(omega_1_meas: Any, omega_1_hat: Any, p: Any) -> Any:
    """The measured speed, or the estimated one where it is out of range or too far from it."""
    omega_1 = speed(omega_1_meas, omega_1_hat, p)
    return where(abs(omega_1 - omega_1_hat) <= p.e_max, omega_1, omega_1_hat)


def has_wheel_speed(u: Any, p: Any) -> Any:
    return logical_and(u.valid, plausible(u.omega_2_can, p.omega_max))


def message(u: Any) -> Any:
    """The received wheel speed in rad/s; zero where it is not finite."""
    return where(is_finite(u.omega_2_can), u.omega_2_can, 0.0)


def is_usable(x: MonitorState, u: Any, omega_2_hat: Any, p: Any) -> Any:
    """Whether a message has arrived that can correct the estimate omega_2_hat (rad/s)."""
    new = logical_and(u.counter != x.counter, has_wheel_speed(u, p))
    return logical_and(new, abs(message(u) - omega_2_hat) <= p.e_max)


def update(x: MonitorState, u: Any, omega_1_hat: Any, T_ref: Any, usable: Any, T_s: Any, p: Any) -> MonitorState:
    """The state after the signals of one sample.

    Args:
        u: input with omega_1_meas, T_mot_est, counter.
        omega_1_hat: estimate of the speed at this sample before its measurement, rad/s.
        T_ref: demand that the motor has, N.m.
        usable: whether a usable message has arrived.
    """
    omega_1, T_mot = speed(u.omega_1_meas, omega_1_hat, p), torque(u.T_mot_est, x.T_mot, p)
    near = abs(omega_1 - omega_1_hat) <= p.e_max
    omega_1_unchanged = where(u.omega_1_meas == x.omega_1_last, x.omega_1_unchanged + T_s, 0.0)
    T_mot_unchanged = where(u.T_mot_est == x.T_mot_last, x.T_mot_unchanged + T_s, 0.0)
    omega_1_frozen = logical_and(omega_1_unchanged >= p.t_frozen, abs(omega_1) > STILL)
    disobeyed = logical_or(abs(T_mot - T_ref) > OBEYED, x.T_mot_frozen)
    T_mot_frozen = logical_and(T_mot_unchanged >= p.t_frozen, disobeyed)
    in_range = logical_and(plausible(u.omega_1_meas, p.omega_max), plausible(u.T_mot_est, 2.0 * p.T_max))
    alive = logical_not(logical_or(omega_1_frozen, T_mot_frozen))
    good = logical_and(logical_and(in_range, near), alive)
    return MonitorState(
        omega_1=near_speed(u.omega_1_meas, omega_1_hat, p),
        T_mot=T_mot,
        omega_1_last=where(is_finite(u.omega_1_meas), u.omega_1_meas, 0.0),
        T_mot_last=where(is_finite(u.T_mot_est), u.T_mot_est, 0.0),
        omega_1_unchanged=minimum(omega_1_unchanged, p.t_frozen),
        T_mot_unchanged=minimum(T_mot_unchanged, p.t_frozen),
        T_mot_frozen=T_mot_frozen,
        bad=where(good, 0.0, minimum(x.bad + T_s, p.t_bad + T_s)),
        counter=1.0 * u.counter,
        silence=where(usable, 0.0, minimum(x.silence + T_s, p.t_stale)),
    )


def trusts_motor(x: MonitorState, p: Any) -> Any:
    return x.bad <= p.t_bad


def hears_wheels(x: MonitorState, u: Any, p: Any) -> Any:
    """Whether the wheel speed is known: valid, and messages keep coming."""
    return logical_and(u.valid, x.silence < p.t_stale)
