"""Direction of the car: that which the bus tells, else that in which a trusted motor turns.

A motor speed of the wrong sign would tell the wrong one. It is found when a demand ends the rest. The motor meets
nothing but its inertia then, until the teeth touch. With s the speed that the demanded torque gives a free motor,
J_1 ds/dt = T, one that turns against it has the speed -s; at the end of the rest it has either. How far the motor
speed is from that is integrated over s up to `free`; the integral of s itself is half the square of `free`. On the
flank of a tooth, thrown back by one, or rocking on ice the motor is too fast or too slow for that.
"""

from typing import Annotated, NamedTuple

from ..block.declaration import Real
from ..block.operators import clip, logical_and, maximum, minimum, sign, where
from .supervision_interface import Input, Parameters, added_speed


class DirectionState(NamedTuple):
    """The direction, and the launch."""

    direction: Annotated[float, Real("1", "1 forwards, -1 backwards")]
    free: Annotated[float, Real("rad/s", "speed that the demanded torque has given a free motor since rest")]
    off: Annotated[float, Real("rad2/s2", "how far the motor is from turning against it, integrated over that speed")]


def start(omega_1: float, T_s: float, p: Parameters) -> DirectionState:
    return DirectionState(where(omega_1 < -p.omega_still, -1.0, 1.0), p.free * added_speed(p, T_s), 0.0)


def update(
    x: DirectionState,
    u: Input,
    T_driver: float,
    T_mot: float,
    omega_1: float,
    resting: bool,
    trusted: bool,
    T_s: float,
    p: Parameters,
) -> tuple[DirectionState, bool]:
    """The state after one sample, and whether the motor has just set off against its torque.

    Args:
        T_driver: demand, N.m.
        T_mot: torque that the motor should have in this sample, N.m.
        omega_1: motor speed in use, rad/s.
        resting: whether the car was at rest until now.
        trusted: whether the motor signals are.
    """
    far = p.free * added_speed(p, T_s)
    demanded = clip(T_mot, minimum(T_driver, 0.0), maximum(T_driver, 0.0))
    counting = abs(x.free) < far
    free = x.free + where(counting, T_s * demanded / p.J_1, 0.0)
    off = x.off + abs(free - x.free) * abs(omega_1 + 0.5 * (free + x.free))
    firm = logical_and(abs(free) >= far, abs(demanded) >= p.firm * p.T_still)
    against = logical_and(logical_and(counting, firm), off <= p.like * 0.5 * free * free)

    turning = logical_and(trusted, abs(omega_1) > p.omega_still)
    direction = where(against, sign(free), where(turning, sign(omega_1), x.direction))
    return DirectionState(
        direction=where(u.direction == 0, direction, sign(1.0 * u.direction)),
        free=where(resting, where(abs(T_driver) > p.T_still, sign(T_driver) * minimum(abs(omega_1), far), far), free),
        off=where(resting, 0.0, off),
    ), against


def has_turned(x: DirectionState, omega_1: float, p: Parameters) -> bool:
    """Whether the motor turns the other way."""
    return x.direction * omega_1 < -p.omega_still
