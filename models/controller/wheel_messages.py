"""The messages with the wheel speed: which are taken, and whether they contradict the motor speed.

A message tells what the wheels did some time ago. So it is compared with the least and the largest speed that the
motor had of late (t_late). One that has leapt out of that range since the message before, while the motor speed has
not, is not taken, and changes nothing. The others correct the estimate, and are a reference for the motor speed.
"""

from typing import Annotated, NamedTuple

from fmublocks.block.declaration import Real
from fmublocks.block.operators import logical_and, logical_not, maximum, minimum, where

from ..physics.vehicle import added_speed
from .motor_signals import in_range
from .supervision_interface import Input, Parameters


class WheelState(NamedTuple):
    """What came last."""

    counter: Annotated[float, Real("1", "counter of the message received last")]
    omega_2: Annotated[float, Real("rad/s", "magnitude of the speed taken last, 0 if there is none")]
    least: Annotated[float, Real("rad/s", "least motor speed of late")]
    largest: Annotated[float, Real("rad/s", "largest motor speed of late")]
    silence: Annotated[float, Real("s", "time since a message was taken")]


def start(u: Input, omega_1: float, p: Parameters) -> WheelState:
    known = tells_a_speed(u, p)
    return WheelState(
        counter=1.0 * u.counter,
        omega_2=where(known, abs(u.omega_2_can), 0.0),
        least=omega_1,
        largest=omega_1,
        silence=where(known, 0.0, p.t_stale),
    )


def tells_a_speed(u: Input, p: Parameters) -> bool:
    """Whether the bus has a speed; that of standing wheels is none, for they have no direction."""
    turning = abs(u.omega_2_can) > p.omega_still
    return logical_and(logical_and(u.valid, turning), in_range(u.omega_2_can, p.omega_max))


def update(
    x: WheelState, u: Input, omega_1: float, strict: bool, apart: bool, direction: float, T_s: float, p: Parameters
) -> tuple[WheelState, bool, bool]:
    """The state after one sample, whether a message was taken in it, and whether it contradicts the motor speed.

    Args:
        u: input with omega_2_can, valid, counter.
        omega_1: motor speed in use, rad/s.
        strict: only the present motor speed counts: it is not what it was before.
        apart: whether the messages have contradicted until now.
        direction: of the car, 1 forwards, -1 backwards; wheel sensors count teeth and have none.
    """
    unit, known = added_speed(p, T_s), tells_a_speed(u, p)
    decay = T_s / p.t_late
    least = where(strict, omega_1, minimum(omega_1, x.least + decay * (omega_1 - x.least)))
    largest = where(strict, omega_1, maximum(omega_1, x.largest + decay * (omega_1 - x.largest)))

    arrives = logical_and(known, u.counter != x.counter)
    speed = where(arrives, abs(u.omega_2_can), where(known, x.omega_2, 0.0))
    signed = direction * speed
    outside = maximum(signed - largest, least - signed) - p.g_radius * speed  # of what the motor speed was
    changed = logical_and(x.omega_2 > 0.0, abs(speed - x.omega_2) > p.wheel_jump * unit)
    leapt = logical_and(logical_and(arrives, changed), outside > p.wheel_jump * unit)
    taken = logical_and(arrives, logical_not(leapt))
    far = where(leapt, apart, logical_and(speed > 0.0, outside > p.wheel_deviation * unit))
    x = WheelState(
        counter=1.0 * u.counter,
        omega_2=where(leapt, x.omega_2, speed),
        least=least,
        largest=largest,
        silence=where(taken, 0.0, minimum(x.silence + T_s, p.t_stale)),
    )
    return x, taken, logical_and(far, is_reference(x, u, p))


def is_reference(x: WheelState, u: Input, p: Parameters) -> bool:
    """Whether messages keep coming that tell a speed."""
    return logical_and(tells_a_speed(u, p), x.silence < p.t_stale)
