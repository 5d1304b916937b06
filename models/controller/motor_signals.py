"""The motor signals: what is wrong with them in a sample, and what is used in their place.

A motor speed is expected near the last one, near what the model makes of it, or where a fast change goes on; it is
frozen where it stays the same while the model moves. A torque is expected near what the motor should have
(torque_loop). What is expected takes the place of what is wrong. A speed that is wrong for longer than t_bad is
followed wherever it is in range, so that it can heal.
"""

from typing import Annotated, NamedTuple

from ..block.declaration import Real
from ..block.operators import clip, logical_and, logical_not, minimum, where
from . import torque_loop
from .causes import FAILURES, NONE, SPEED_FROZEN, SPEED_JUMP, SPEED_RANGE, TORQUE_IMPLAUSIBLE
from .supervision_interface import Input, Parameters, added_speed
from .torque_loop import LoopState


class MotorState(NamedTuple):
    """What was used last."""

    omega_1: Annotated[float, Real("rad/s", "motor speed used last")]
    received: Annotated[float, Real("rad/s", "motor speed received last, where it was in range")]
    change: Annotated[float, Real("rad/s", "change of what was received, in that sample")]
    movement: Annotated[float, Real("rad/s", "movement that the model has expected since the speed changed")]
    T_mot: Annotated[float, Real("N.m", "torque estimate used last")]
    loop: LoopState
    bad: Annotated[float, Real("s", "time since the motor signals were good")]


def start(u: Input, p: Parameters) -> MotorState:
    omega_1 = where(in_range(u.omega_1_meas, p.omega_max), u.omega_1_meas, 0.0)
    T_mot = where(in_range(u.T_mot_est, 2.0 * p.T_max), u.T_mot_est, 0.0)
    return MotorState(omega_1, omega_1, 0.0, 0.0, T_mot, torque_loop.start(T_mot), 0.0)


def in_range(signal: float, limit: float) -> bool:
    """A number, and at most the limit in magnitude."""
    return abs(signal) <= limit


def torque(T_mot_est: float, loop: LoopState, p: Parameters) -> float:
    """The torque estimate, or what the motor should have where it cannot be that."""
    return where(torque_loop.agrees(loop, T_mot_est, p), T_mot_est, loop.T_mot)


def update(
    x: MotorState, u: Input, increment: float, T_ref: float, T_s: float, p: Parameters
) -> tuple[MotorState, int]:
    """The state after the signals of one sample, and what is wrong with them.

    Args:
        u: input with omega_1_meas, T_mot_est.
        increment: change of the model's motor speed since the last sample, rad/s.
        T_ref: demand that the motor has, N.m.
    """
    unit, most = added_speed(p, T_s), p.jump * added_speed(p, T_s)
    expected = clip(x.omega_1 + increment, -p.omega_max, p.omega_max)
    ranges = in_range(u.omega_1_meas, p.omega_max)
    omega_1 = where(ranges, u.omega_1_meas, expected)
    fast = logical_and(x.bad > 0.0, abs(x.change) > most)
    goes_on = logical_and(fast, abs(omega_1 - x.received - x.change) <= most)
    far = minimum(abs(omega_1 - x.omega_1), abs(omega_1 - expected)) > most
    jumps = logical_and(far, logical_not(goes_on))
    moved = where(x.bad > 0.0, x.movement, x.movement + increment - minimum(T_s / p.t_move, 1.0) * x.movement)
    movement = where(u.omega_1_meas == x.omega_1, moved, 0.0)
    frozen = logical_and(abs(movement) > p.q_omega + p.frozen * unit, abs(omega_1) > p.omega_still)

    wrong = logical_not(torque_loop.agrees(x.loop, u.T_mot_est, p))
    found = {SPEED_RANGE: logical_not(ranges), SPEED_JUMP: jumps, SPEED_FROZEN: frozen, TORQUE_IMPLAUSIBLE: wrong}
    finding = NONE
    for row in reversed(FAILURES):
        finding = where(found.get(row.number, False), row.number, finding)
    bad = where(finding == NONE, 0.0, minimum(x.bad + T_s, p.t_bad + T_s))
    return MotorState(
        omega_1=where(logical_and(jumps, bad <= p.t_bad), expected, omega_1),
        received=omega_1,
        change=omega_1 - x.received,
        movement=movement,
        T_mot=torque(u.T_mot_est, x.loop, p),
        loop=torque_loop.update(x.loop, T_ref, T_s, p),
        bad=bad,
    ), finding
