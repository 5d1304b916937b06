"""What the messages with the wheel speed are good for: to correct the estimate, and as a witness.

A message corrects the estimate when it is new, valid, finite, in range and near it; the wheel speed is in
use while such messages keep coming. Any message that says a speed is a witness against a motor speed that
is far from it, unless it is the messages that have leapt: then they are doubted, until one corrects the
estimate again.
"""

from typing import Annotated, Any, NamedTuple

from ..block.declaration import Boolean, Real
from ..block.operators import is_finite, logical_and, logical_not, logical_or, minimum, where
from .signal_monitor import plausible

LATE = 0.025
"""Time in s by which the motor speed is held back to compare it with messages, about their age."""

SHARE = 0.06
"""Of the wheel speed, by which the motor speed may differ from it more: the error of the wheel radius."""


class WheelState(NamedTuple):
    """State of the wheel monitor."""

    counter: Annotated[float, Real("1", "counter of the message received last")]
    omega_2: Annotated[float, Real("rad/s", "speed received last")]
    usable: Annotated[bool, Boolean("a message has come that corrects the estimate")]
    unused: Annotated[float, Real("s", "time since such a message")]
    silence: Annotated[float, Real("s", "time since a message that says a speed")]
    doubted: Annotated[bool, Boolean("the messages have leapt away from the estimate")]
    witness: Annotated[bool, Boolean("the messages say what the motor speed must be")]
    late: Annotated[float, Real("rad/s", "motor speed, as late as the messages")]
    apart: Annotated[float, Real("s", "time for which messages contradict the motor speed")]


def start(u: Any, omega_1: Any, p: Any) -> WheelState:
    known = has_wheel_speed(u, p)
    return WheelState(
        counter=1.0 * u.counter,
        omega_2=message(u),
        usable=False,
        unused=where(known, 0.0, p.t_stale),
        silence=where(known, 0.0, p.t_stale),
        doubted=False,
        witness=known,
        late=omega_1,
        apart=0.0,
    )


def has_wheel_speed(u: Any, p: Any) -> Any:
    return logical_and(u.valid, plausible(u.omega_2_can, p.omega_max))


def message(u: Any) -> Any:
    """The received wheel speed in rad/s; zero where it is not finite."""
    return where(is_finite(u.omega_2_can), u.omega_2_can, 0.0)


def update(x: WheelState, u: Any, omega_1: Any, omega_2_hat: Any, T_s: Any, p: Any) -> WheelState:
    """The state after one sample.

    Args:
        u: input with omega_2_can, valid, counter.
        omega_1: motor speed in use, rad/s.
        omega_2_hat: estimate before the message, rad/s.
    """
    omega_2 = message(u)
    known = has_wheel_speed(u, p)
    new = logical_and(u.counter != x.counter, known)
    usable = logical_and(new, abs(omega_2 - omega_2_hat) <= p.e_max)
    leapt = logical_and(new, abs(omega_2 - x.omega_2) > p.e_max)
    silence = where(new, 0.0, minimum(x.silence + T_s, p.t_stale))
    doubted = logical_and(logical_or(x.doubted, leapt), logical_not(usable))
    late = x.late + minimum(T_s / LATE, 1.0) * (omega_1 - x.late)
    witness = logical_and(logical_and(known, silence < p.t_stale), logical_not(doubted))
    far = abs(omega_2 - late) > p.e_wheel + SHARE * abs(omega_2)
    return WheelState(
        counter=1.0 * u.counter,
        omega_2=omega_2,
        usable=usable,
        unused=where(usable, 0.0, minimum(x.unused + T_s, p.t_stale)),
        silence=silence,
        doubted=doubted,
        witness=witness,
        late=late,
        apart=where(logical_and(witness, far), minimum(x.apart + T_s, p.t_apart + T_s), 0.0),
    )


def hears_wheels(x: WheelState, u: Any, p: Any) -> Any:
    """Whether the wheel speed is in use: valid, and messages that can be used keep coming."""
    return logical_and(u.valid, x.unused < p.t_stale)
