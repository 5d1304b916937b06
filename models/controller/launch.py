"""A motor that sets off against its torque: its speed has the wrong sign.

It is looked for when a demand ends the rest. The motor meets nothing but its inertia then, until the teeth touch. With
s the speed that the demanded torque gives a free motor, J_1 ds/dt = T, one that turns against it has the speed -s. How
far the motor speed is from that is integrated over s up to `launch_speed`; the integral of s itself is half the square
of that. On the flank of a tooth, thrown back by one, or rocking on ice the motor is too fast or too slow for that.
"""

from typing import Annotated, NamedTuple

from fmublocks.block.declaration import Real
from fmublocks.block.operators import logical_and, where

from ..physics.vehicle import added_speed
from .supervision_interface import Parameters


class LaunchState(NamedTuple):
    """The launch."""

    free: Annotated[float, Real("rad/s", "speed that the demanded torque has given a free motor since rest")]
    off: Annotated[float, Real("rad2/s2", "how far the motor is from turning against it, integrated over that speed")]


def start(T_s: float, p: Parameters) -> LaunchState:
    return LaunchState(p.launch_speed * added_speed(p, T_s), 0.0)


def update(
    x: LaunchState, T_driver: float, T_mot: float, omega_1: float, resting: bool, T_s: float, p: Parameters
) -> tuple[LaunchState, bool]:
    """The state after one sample, and whether the motor has just set off against its torque.

    Args:
        T_driver: demand, N.m; none: what moves the car is no launch.
        T_mot: torque that the motor should have in this sample, N.m.
        omega_1: motor speed in use, rad/s.
        resting: whether the car was at rest until now.
    """
    far = p.launch_speed * added_speed(p, T_s)
    counting = logical_and(abs(x.free) < far, T_mot * T_driver > 0.0)
    gained = T_s * T_mot / p.J_1
    free = x.free + where(counting, gained, 0.0)
    off = x.off + where(counting, abs(gained * (omega_1 + x.free + 0.5 * gained)), 0.0)
    against = logical_and(logical_and(counting, abs(free) >= far), off <= p.launch_tolerance * 0.5 * free * free)
    none = abs(T_driver) <= p.T_still
    return LaunchState(where(resting, 0.0, where(none, far, free)), where(resting, 0.0, off)), against
