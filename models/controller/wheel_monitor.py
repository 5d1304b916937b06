"""What the messages with the wheel speed are good for: to correct the estimate, and as a reference for the motor speed.

A message corrects the estimate when it is new, valid, in range, plausible and near it; the wheel speed is in use
while such messages keep coming. Any message that says a speed is a valid reference for the motor speed, unless
the messages have leapt from one to the next while the motor speed has not: then they are implausible, until one
is near the motor speed again. A motor speed mismatches when it is far from the reference now and was so when the
message came: wheels that lock leave the last message behind in between.

The teeth of a wheel do not tell its direction. It is taken from the motor while the messages are silent or
implausible, and kept otherwise: a car that turns round passes the speeds at which they say nothing. A motor that
turns backwards while it pushes hard has the wrong sign, unless the car was seen to roll back before it pushed, or the
motor to set off with its torque (launch direction). One that has set off against it goes where that torque pushes.
"""

from typing import Annotated, NamedTuple

from ..block.declaration import Boolean, Real
from ..block.operators import clip, is_finite, logical_and, logical_not, logical_or, minimum, where
from . import launch_direction
from .launch_direction import LaunchState
from .signal_monitor import plausible
from .supervision_interface import Input, Parameters

PUSH = 0.25
"""Torque over T_max with which no car begins to roll backwards."""

LATE = 0.025
"""Time in s by which the motor speed is held back to compare it with messages, about their age."""

SHARE = 0.06
"""Of the wheel speed, by which the motor speed may differ from it more: the error of the wheel radius."""

LEAP = 20.0
"""Change in rad/s from one message to the next that the motor speed has to follow."""

ROLLING = 0.1
"""Time in s for which a motor that does not push turns backwards when the car rolls back; it crosses the gap sooner."""


class WheelState(NamedTuple):
    """State of the wheel monitor."""

    counter: Annotated[float, Real("1", "counter of the message received last")]
    omega_2: Annotated[float, Real("rad/s", "speed received last, with its direction")]
    direction: Annotated[float, Real("1", "1 forwards, -1 backwards")]
    rolling: Annotated[float, Real("s", "time for which the car was seen to roll back, up to twice what is needed")]
    usable: Annotated[bool, Boolean("a message has come that corrects the estimate")]
    unused: Annotated[float, Real("s", "time since such a message")]
    silence: Annotated[float, Real("s", "time since a message that says a speed")]
    implausible: Annotated[bool, Boolean("the messages have leapt away from the motor speed")]
    reference_valid: Annotated[bool, Boolean("the messages are a reference for the motor speed")]
    late: Annotated[float, Real("rad/s", "motor speed, as late as the messages")]
    late_then: Annotated[float, Real("rad/s", "that speed at the message received last")]
    mismatch_time: Annotated[float, Real("s", "time for which motor speed and messages do not match")]


def start(u: Input, omega_1: float, T_mot: float, p: Parameters) -> WheelState:
    known = has_wheel_speed(u, p)
    direction = direction_of(omega_1, T_mot, 0.0, launch_direction.start(), p)
    return WheelState(
        counter=1.0 * u.counter,
        omega_2=direction * message(u),
        direction=direction,
        rolling=0.0,
        usable=False,
        unused=where(known, 0.0, p.t_stale),
        silence=where(known, 0.0, p.t_stale),
        implausible=False,
        reference_valid=known,
        late=omega_1,
        late_then=omega_1,
        mismatch_time=0.0,
    )


def has_wheel_speed(u: Input, p: Parameters) -> bool:
    """Whether a message says a speed; that of standing wheels is none, for they tell no direction."""
    turning = abs(u.omega_2_can) > p.omega_still
    return logical_and(logical_and(u.valid, turning), plausible(u.omega_2_can, p.omega_max))


def message(u: Input) -> float:
    """Magnitude of the received wheel speed in rad/s; zero where it is not finite."""
    return where(is_finite(u.omega_2_can), abs(u.omega_2_can), 0.0)


def is_backwards(omega_1: float, p: Parameters) -> bool:
    return omega_1 < -p.omega_still


def is_pushing(T_mot: float, p: Parameters) -> bool:
    """Whether the motor pushes so hard that no car begins to roll back on usual slopes."""
    return T_mot >= PUSH * p.T_max


def direction_of(omega_1: float, T_mot: float, rolling: float, launch: LaunchState, p: Parameters) -> float:
    """Of a car whose motor turns with omega_1 (rad/s) under T_mot (N.m), and that was rolling back for so long (s)."""
    believed = logical_or(rolling >= ROLLING, launch_direction.is_with(launch))
    possible = logical_or(logical_not(is_pushing(T_mot, p)), believed)
    turning = where(logical_and(is_backwards(omega_1, p), possible), -1.0, 1.0)
    wrong = logical_or(launch_direction.is_against(launch), launch.wrong_sign)
    return where(wrong, launch_direction.heading(launch), turning)


def rolling_time(rolling: float, omega_1: float, T_mot: float, wrong: bool, T_s: float, p: Parameters) -> float:
    """Time in s for which the car was seen to roll back, one sample later.

    It counts while the motor does not push, stays while it does, and is taken back while the motor does not turn
    backwards; a motor speed that is bad or has the wrong sign does not count.
    """
    step = where(is_backwards(omega_1, p), where(is_pushing(T_mot, p), 0.0, T_s), -T_s)
    return where(wrong, 0.0, clip(rolling + step, 0.0, 2.0 * ROLLING))


def update(
    x: WheelState,
    u: Input,
    omega_1: float,
    T_mot: float,
    bad: float,
    launch: LaunchState,
    omega_2_hat: float,
    T_s: float,
    p: Parameters,
) -> WheelState:
    """The state after one sample.

    Args:
        u: input with omega_2_can, valid, counter.
        omega_1, T_mot: motor speed and torque in use, rad/s and N.m.
        bad: time in s since the motor signals were good.
        launch: the launch direction.
        omega_2_hat: estimate before the message, rad/s.
    """
    known = has_wheel_speed(u, p)
    believed = logical_and(x.silence < p.t_stale, logical_not(x.implausible))
    rolling = rolling_time(x.rolling, omega_1, T_mot, logical_or(bad > 0.0, launch.wrong_sign), T_s, p)
    direction = where(believed, x.direction, direction_of(omega_1, T_mot, rolling, launch, p))
    new = logical_and(u.counter != x.counter, known)
    omega_2 = where(new, direction * message(u), x.omega_2)
    late = x.late + minimum(T_s / LATE, 1.0) * (omega_1 - x.late)
    distance, allowed = abs(omega_2 - late), SHARE * abs(omega_2)
    implausible = logical_and(logical_or(x.implausible, has_leapt(x, omega_2, late, p)), distance > LEAP + allowed)
    near = logical_and(abs(omega_2 - omega_2_hat) <= p.e_max, logical_not(implausible))
    usable = logical_and(new, near)
    silence = where(new, 0.0, minimum(x.silence + T_s, p.t_stale))
    reference_valid = logical_and(logical_and(known, silence < p.t_stale), logical_not(implausible))
    late_then = where(new, late, x.late_then)
    far = minimum(distance, abs(omega_2 - late_then)) > p.e_wheel + allowed
    return WheelState(
        counter=1.0 * u.counter,
        omega_2=omega_2,
        direction=direction,
        rolling=rolling,
        usable=usable,
        unused=where(usable, 0.0, minimum(x.unused + T_s, p.t_stale)),
        silence=silence,
        implausible=implausible,
        reference_valid=reference_valid,
        late=late,
        late_then=late_then,
        mismatch_time=where(logical_and(reference_valid, far), minimum(x.mismatch_time + T_s, p.t_apart + T_s), 0.0),
    )


def has_leapt(x: WheelState, omega_2: float, late: float, p: Parameters) -> bool:
    """Whether the messages have, to omega_2 (rad/s), and the motor speed has not."""
    change, moved = omega_2 - x.omega_2, late - x.late_then
    leapt = logical_and(abs(change) > LEAP, abs(change - moved) > LEAP)
    return logical_and(leapt, x.silence < p.t_stale)


def wheel_speed_in_use(x: WheelState, u: Input, p: Parameters) -> bool:
    """Whether the wheel speed is in use: valid, and messages that can be used keep coming."""
    return logical_and(u.valid, x.unused < p.t_stale)
