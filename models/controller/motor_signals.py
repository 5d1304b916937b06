"""The motor signals: what is wrong with them in a sample, and what is used in their place.

A motor speed is expected near the last one, near what the model makes of it, or where a fast change goes on; it is
frozen where it stays the same while the model moves. A torque is expected near what the motor should have
(torque_loop). What is expected takes the place of what is wrong, and of a frame that is not new. Without trust, a speed
is followed wherever it is in range, so that it can heal.

Where frames are counted (`alive`), their age is known beyond that of the youngest: it grows with time, and becomes less
by T_frame with every frame. It is forgotten as two clocks part.
"""

from typing import Annotated, NamedTuple

from fmublocks.block.declaration import Real
from fmublocks.block.operators import logical_and, logical_not, logical_or, maximum, where

from ..physics.vehicle import added_speed
from . import torque_loop
from .causes import FRAME_LATE, SPEED_FROZEN, SPEED_JUMP, SPEED_RANGE, TORQUE_IMPLAUSIBLE
from .supervision_interface import Input, Parameters
from .torque_loop import LoopState

DRIFT = 2e-4
"""Share by which the clocks of two control units part at most: quartz, 100 ppm each."""

ANEW = 1.0
"""Age in s of a frame that is none: its sender has begun to count anew."""


class MotorState(NamedTuple):
    """What came and was used last, and what is expected next."""

    alive: Annotated[float, Real("1", "counter of the frame received last")]
    age: Annotated[float, Real("s", "of that frame, beyond that of the youngest")]
    omega_1: Annotated[float, Real("rad/s", "motor speed used last")]
    received: Annotated[float, Real("rad/s", "motor speed received last, or what stood for one out of range")]
    change: Annotated[float, Real("rad/s", "change of what was received, in that sample")]
    movement: Annotated[float, Real("rad/s", "movement that the model expects since the speed changed")]
    loop: LoopState


def start(u: Input, p: Parameters) -> MotorState:
    omega_1 = where(in_range(u.omega_1_meas, p.omega_max), u.omega_1_meas, 0.0)
    T_mot = where(in_range(u.T_mot_est, 2.0 * p.T_max), u.T_mot_est, 0.0)
    return MotorState(1.0 * u.alive - 1.0, 0.0, omega_1, omega_1, 0.0, 0.0, LoopState(T_mot))


def filled(x: MotorState, u: Input, expected: float) -> Input:
    """The input with the motor speed (rad/s) and the torque that are expected where the frame is not new."""
    new = logical_or(u.alive != x.alive, u.alive == 0)
    return u._replace(
        omega_1_meas=where(new, u.omega_1_meas, expected), T_mot_est=where(new, u.T_mot_est, x.loop.T_mot)
    )


def age_of_frame(x: MotorState, u: Input, T_s: float, p: Parameters) -> float:
    """Age in s of the frame of this sample."""
    age = maximum(x.age + (1.0 - DRIFT) * T_s - p.T_frame * (u.alive - x.alive), 0.0)
    return where(logical_and(u.alive != 0, age < ANEW), age, 0.0)


def in_range(signal: float, limit: float) -> bool:
    """A number, and at most the limit in magnitude."""
    return abs(signal) <= limit


def torque(x: MotorState, T_mot_est: float, p: Parameters) -> float:
    """The torque estimate, or what the motor should have where it cannot be that."""
    return where(torque_loop.agrees(x.loop, T_mot_est, p), T_mot_est, x.loop.T_mot)


def update(
    x: MotorState, u: Input, expected: float, trusted: bool, T_s: float, p: Parameters
) -> tuple[MotorState, float, dict[int, bool]]:
    """The state with the signals of one sample, the motor speed that is used (rad/s), and what is wrong with them.

    Args:
        u: input with alive, and omega_1_meas, T_mot_est as `filled`.
        expected: motor speed that the model makes of the last one, rad/s.
        trusted: whether the motor signals were trusted until now.
    """
    most, age = p.jump * added_speed(p, T_s), age_of_frame(x, u, T_s, p)
    near = logical_or(abs(u.omega_1_meas - x.omega_1) <= most, abs(u.omega_1_meas - expected) <= most)
    ranges = logical_or(in_range(u.omega_1_meas, p.omega_max), near)  # wheels that spin get there step by step
    omega_1 = where(ranges, u.omega_1_meas, expected)
    change, waited = omega_1 - x.received, x.received != x.omega_1
    goes_on = logical_and(logical_and(waited, abs(x.change) > most), abs(change - x.change) <= most)
    jumps = logical_and(ranges, logical_not(logical_or(near, goes_on)))
    movement = where(u.omega_1_meas == x.received, x.movement, 0.0)
    failures = {
        SPEED_RANGE: logical_not(ranges),
        SPEED_JUMP: jumps,
        SPEED_FROZEN: logical_and(is_movement(movement, T_s, p), abs(omega_1) > p.omega_still),
        TORQUE_IMPLAUSIBLE: logical_not(torque_loop.agrees(x.loop, u.T_mot_est, p)),
        FRAME_LATE: age > p.t_bad,
    }
    used = where(logical_and(jumps, trusted), expected, omega_1)
    x = x._replace(alive=1.0 * u.alive, age=age, omega_1=used, received=omega_1, change=change, movement=movement)
    return x, used, failures


def is_movement(movement: float, T_s: float, p: Parameters) -> bool:
    """Whether a movement (rad/s) is more than the resolution of the speed and an error of the model."""
    return abs(movement) > p.q_omega + p.frozen * added_speed(p, T_s)


def predict(x: MotorState, loop: LoopState, increment: float, T_s: float, p: Parameters) -> MotorState:
    """The state with the torque that the motor should have next, and the movement (rad/s) expected until then.

    What is a movement stays one until the speed changes.
    """
    movement = x.movement + increment - T_s / p.t_move * x.movement
    return x._replace(movement=where(is_movement(x.movement, T_s, p), x.movement, movement), loop=loop)
