"""Which of the received motor signals can be used: those that are good, else what is expected in their place.

A motor speed is bad when it is not finite, out of range, jumping (far from the speed of the last sample,
from where that was going, and from what the model expects), frozen (unchanged for t_frozen while the motor
turns, although noise has moved it before or the model expects it to move by more than its resolution, the
smallest change that was seen; and from then on until it changes); a motor torque when it is not finite, out
of range, or far from what the motor should have (torque_loop). A speed that is bad for longer than t_bad is
followed wherever it is plausible, so that it can heal (trust).
"""

from typing import Annotated, NamedTuple

from ..block.declaration import Boolean, Real
from ..block.operators import clip, is_finite, logical_and, logical_not, logical_or, minimum, where
from . import torque_loop
from .supervision_interface import Input, Parameters
from .torque_loop import LoopState

STILL = 1.0
"""Motor speed in rad/s below which an unchanging speed is taken for standstill."""

COARSE = 1.0
"""Resolution in rad/s that a motor speed has until a finer one was seen."""

DRIFT = 0.3
"""Movement in rad/s that the noise of the torque makes the model expect."""

T_MOVE = 0.1
"""Time in s for which a movement is remembered that the model has expected."""

NOISY = 1.5
"""Change over the resolution, to and fro from one sample to the next, that only noise makes."""

OFTEN = 0.02
"""Share of the samples with such changes from which on a speed is noisy, and never stays the same for long."""

T_NOISE = 0.5
"""Time in s over which that share is taken."""


class MonitorState(NamedTuple):
    """State of the signal monitor."""

    omega_1: Annotated[float, Real("rad/s", "motor speed used last")]
    omega_1_change: Annotated[float, Real("rad/s", "its change in that sample")]
    T_mot: Annotated[float, Real("N.m", "torque estimate used last")]
    omega_1_last: Annotated[float, Real("rad/s", "motor speed received last")]
    omega_1_unchanged: Annotated[float, Real("s", "time since that speed changed")]
    change: Annotated[float, Real("rad/s", "by which it had changed then")]
    noise: Annotated[float, Real("1", "share of the samples in which noise has moved it by more than its resolution")]
    resolution: Annotated[float, Real("rad/s", "smallest change of that speed that was seen")]
    movement: Annotated[float, Real("rad/s", "movement that the model has expected since that speed changed")]
    frozen: Annotated[bool, Boolean("that speed has not moved where it should have")]
    loop: LoopState
    bad: Annotated[float, Real("s", "time since the motor signals were good")]


def start(u: Input, p: Parameters) -> MonitorState:
    omega_1 = speed(u.omega_1_meas, 0.0, p)
    T_mot = where(plausible(u.T_mot_est, 2.0 * p.T_max), u.T_mot_est, 0.0)
    return MonitorState(
        omega_1=omega_1,
        omega_1_change=0.0,
        T_mot=T_mot,
        omega_1_last=omega_1,
        omega_1_unchanged=0.0,
        change=0.0,
        noise=0.0,
        resolution=COARSE,
        movement=0.0,
        frozen=False,
        loop=torque_loop.start(T_mot),
        bad=0.0,
    )


def plausible(signal: float, limit: float) -> bool:
    """Finite and at most the limit in magnitude."""
    return logical_and(is_finite(signal), abs(signal) <= limit)


def is_torque(T_mot_est: float, loop: LoopState, p: Parameters) -> bool:
    """Whether a torque estimate (N.m) is in range, and can be that of what the motor should have."""
    return logical_and(plausible(T_mot_est, 2.0 * p.T_max), torque_loop.agrees(loop, T_mot_est, p))


def torque(T_mot_est: float, loop: LoopState, p: Parameters) -> float:
    """The torque estimate, or what the motor should have where it cannot be that."""
    return where(is_torque(T_mot_est, loop, p), T_mot_est, loop.T_mot)


def speed(omega_1_meas: float, expected: float, p: Parameters) -> float:
    """The measured speed, or the expected one where it is out of range."""
    return where(plausible(omega_1_meas, p.omega_max), omega_1_meas, expected)


def is_near(x: MonitorState, omega_1: float, expected: float, p: Parameters) -> bool:
    """Whether a speed is near that of the last sample, where that was going, or what is expected (rad/s)."""
    going, last = abs(omega_1 - x.omega_1 - x.omega_1_change), abs(omega_1 - x.omega_1)
    return minimum(minimum(going, last), abs(omega_1 - expected)) <= p.e_jump


def noise_share(x: MonitorState, change: float, T_s: float) -> float:
    """Share of the samples in which noise moves the motor speed, after one with this change (rad/s)."""
    turned, least = change * x.change < 0.0, minimum(abs(change), abs(x.change))
    noisy = where(logical_and(turned, least > NOISY * x.resolution), 1.0, 0.0)
    return x.noise + minimum(T_s / T_NOISE, 1.0) * (noisy - x.noise)


def update(x: MonitorState, u: Input, increment: float, T_ref: float, T_s: float, p: Parameters) -> MonitorState:
    """The state after the signals of one sample.

    Args:
        u: input with omega_1_meas, T_mot_est.
        increment: change of the model's motor speed since the last sample, rad/s.
        T_ref: demand that the motor has, N.m.
    """
    expected = clip(x.omega_1 + increment, -p.omega_max, p.omega_max)
    omega_1, T_mot = speed(u.omega_1_meas, expected, p), torque(u.T_mot_est, x.loop, p)
    near = is_near(x, omega_1, expected, p)
    received = where(is_finite(u.omega_1_meas), u.omega_1_meas, 0.0)
    change = received - x.omega_1_last
    unchanged = change == 0.0
    omega_1_unchanged = where(u.omega_1_meas == x.omega_1_last, x.omega_1_unchanged + T_s, 0.0)
    movement = where(unchanged, x.movement * (1.0 - minimum(T_s / T_MOVE, 1.0)) + increment, 0.0)
    should_move = logical_or(x.noise > OFTEN, abs(movement) > x.resolution + DRIFT)
    stays = logical_and(omega_1_unchanged >= p.t_frozen, abs(omega_1) > STILL)
    frozen = logical_and(stays, logical_or(x.frozen, should_move))
    possible = logical_and(plausible(u.omega_1_meas, p.omega_max), is_torque(u.T_mot_est, x.loop, p))
    good = logical_and(logical_and(possible, near), logical_not(frozen))
    bad = where(good, 0.0, minimum(x.bad + T_s, p.t_bad + T_s))
    used = where(logical_or(near, bad > p.t_bad), omega_1, expected)
    return MonitorState(
        omega_1=used,
        omega_1_change=used - x.omega_1,
        T_mot=T_mot,
        omega_1_last=received,
        omega_1_unchanged=minimum(omega_1_unchanged, p.t_frozen),
        change=change,
        noise=where(unchanged, x.noise, noise_share(x, change, T_s)),
        resolution=where(unchanged, x.resolution, minimum(abs(change), x.resolution)),
        movement=movement,
        frozen=frozen,
        loop=torque_loop.update(x.loop, T_ref, T_s, p),
        bad=bad,
    )
