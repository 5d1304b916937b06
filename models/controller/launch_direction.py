"""Launch direction: whether the motor sets off the way in which its torque pushes it.

A demand that ends the rest meets nothing but the inertia of the motor until the teeth touch. With s the speed that
the torque gives a free motor, J_1 ds/dt = T_mot, a speed of the right sign is s and one of the wrong sign -s. What
is looked at is how far it is from s and from -s, integrated over s from 0 to FREE and compared with FREE^2/2, the
integral of s itself. Whatever else the motor does tells nothing: on the flank of a tooth say, or thrown back by one.
Nor does a car that rolls before it is pushed, or the damping torque, which always pushes against the motion.
"""

from typing import Annotated, NamedTuple

from ..block.declaration import Boolean, Real
from ..block.operators import clip, logical_and, logical_not, maximum, minimum, sign, where
from .supervision_interface import Parameters

FREE = 4.5
"""Speed in rad/s that the torque must give a free motor before it is looked at: sensor noise is far below."""

FIRM = 1.5
"""Torque over T_still that must push it then: with less its offset decides, and the flanks throw it about."""

LIKE = 0.25
"""Share of FREE^2/2 that it may be off: with a slow launch it is less, with a car that rocks on ice more."""


class LaunchState(NamedTuple):
    """State of the detection of the launch direction."""

    pushed: Annotated[bool, Boolean("it was the demand that has ended the rest")]
    free: Annotated[float, Real("rad/s", "speed that the demanded torque gives a free motor, until it is FREE")]
    turned: Annotated[float, Real("rad/s", "measured change of the motor speed meanwhile")]
    off_with: Annotated[
        float, Real("rad2/s2", "how far it is from turning with the torque, integrated over the speed of a free motor")
    ]
    off_against: Annotated[float, Real("rad2/s2", "how far it is from turning against it, integrated likewise")]
    way: Annotated[float, Real("1", "1 the motor has set off with its torque, -1 against it, 0 not known")]
    wrong_sign: Annotated[bool, Boolean("in fallback, its speed has the sign against which it has set off")]


def start() -> LaunchState:
    return LaunchState(pushed=False, free=0.0, turned=0.0, off_with=0.0, off_against=0.0, way=0.0, wrong_sign=False)


def update(
    x: LaunchState,
    T_driver: float,
    T_mot: float,
    omega_1: float,
    change: float,
    resting: bool,
    launching: bool,
    trusted: bool,
    T_s: float,
    p: Parameters,
) -> LaunchState:
    """The state after one sample.

    Args:
        T_driver: demand, N.m.
        T_mot: torque that the motor should have in this sample, N.m.
        omega_1, change: motor speed, and its change in this sample, rad/s.
        resting, launching: whether the car was at rest until now, and was so a moment ago.
        trusted: whether the motor signals were trusted until now.
    """
    pushed = where(resting, abs(T_driver) > p.T_still, x.pushed)
    counting = logical_and(logical_and(x.pushed, launching), abs(x.free) < FREE)
    demanded = clip(T_mot, minimum(T_driver, 0.0), maximum(T_driver, 0.0))
    free = x.free + where(counting, T_s * demanded / p.J_1, 0.0)
    turned = x.turned + where(counting, change, 0.0)
    seen = logical_and(logical_and(counting, abs(free) >= FREE), abs(demanded) >= FIRM * p.T_still)
    between, gained = 0.5 * (x.free + free), abs(free - x.free)
    off_with = x.off_with + gained * abs(turned - between)
    off_against = x.off_against + gained * abs(turned + between)
    failing = logical_not(trusted)
    forgotten = logical_and(failing, logical_not(launching))
    most = LIKE * 0.5 * free * free
    looks = where(off_with <= most, 1.0, where(off_against <= most, -1.0, 0.0))
    way = where(seen, looks, where(forgotten, minimum(x.way, 0.0), x.way))
    opposite = sign(x.free) * omega_1 < -p.omega_still
    return LaunchState(
        pushed=pushed,
        free=where(resting, 0.0, free),
        turned=where(resting, 0.0, turned),
        off_with=where(resting, 0.0, off_with),
        off_against=where(resting, 0.0, off_against),
        way=where(resting, 0.0, way),
        wrong_sign=logical_and(logical_and(launching, failing), logical_and(is_with(x), opposite)),
    )


def is_against(x: LaunchState) -> bool:
    """Whether it has set off against its torque: its speed has the wrong sign."""
    return x.way < 0.0


def is_with(x: LaunchState) -> bool:
    """Whether it has set off with its torque: its speed has the right sign."""
    return x.way > 0.0


def heading(x: LaunchState) -> float:
    """Direction in which the torque has pushed the car out of rest: 1 forwards, -1 backwards, 0 not known."""
    return sign(x.free)
