"""Trust in the motor signals: lost by one of the causes, got back when it has healed; and the direction of the car.

A wheel speed has no sign. The direction of the car is that which the bus tells, else that in which a trusted motor
turns.
"""

from collections.abc import Mapping
from typing import Annotated, Any, NamedTuple

from ..block.declaration import Real
from ..block.operators import logical_and, logical_not, logical_or, minimum, sign, where
from .causes import CLOCKS, NONE, WRONG_DIRECTION
from .supervision_interface import Input, Parameters


class TrustState(NamedTuple):
    """The cause of the fallback, how far it has healed, and the direction."""

    cause: Annotated[int, Real("1", "number of the cause, that of none while the motor signals are trusted")]
    healing: Annotated[float, Real("s", "time for which the motor signals have been good")]
    direction: Annotated[float, Real("1", "of the car, 1 forwards, -1 backwards")]


class Found(NamedTuple):
    """What was found in a sample.

    Attributes:
        cause: its number.
        lasting: for how long it has been found, s; 0 if it is not.
    """

    cause: int
    lasting: float


def start(omega_1: float, p: Parameters) -> TrustState:
    return TrustState(NONE, 0.0, where(omega_1 < -p.omega_still, -1.0, 1.0))


def is_trusted(x: TrustState) -> bool:
    return x.cause == NONE


def direction(x: TrustState, u: Input, omega_1: float, good: bool, p: Parameters) -> float:
    """Of the car in this sample, by the motor speed (rad/s) where it is good."""
    turning = logical_and(logical_and(is_trusted(x), good), abs(omega_1) > p.omega_still)
    return where(u.direction == 0, where(turning, sign(omega_1), x.direction), sign(1.0 * u.direction))


def update(
    x: TrustState, found: Mapping[str, Found], against: bool, direction: float, turned: bool, T_s: float, p: Parameters
) -> TrustState:
    """The state after one sample.

    Args:
        found: in it, by the parameter with the time after which it counts.
        against: the motor has just set off against its torque.
        direction: of the car.
        turned: whether the motor turns the other way.
    """
    limits: Any = p
    cause, good = NONE, True
    for after in reversed(CLOCKS):
        cause = where(found[after].lasting > getattr(limits, after), found[after].cause, cause)
        good = logical_and(good, found[after].lasting <= 0.0)
    cause = where(against, WRONG_DIRECTION, cause)
    wrong = logical_or(against, logical_and(turned, x.cause == WRONG_DIRECTION))
    healing = where(logical_and(good, logical_not(wrong)), minimum(x.healing + T_s, p.t_turn), 0.0)
    healed = healing >= where(turned, p.t_turn, p.t_proof) - 0.5 * T_s
    return TrustState(where(is_trusted(x), cause, where(healed, NONE, x.cause)), healing, direction)


def is_healing(x: TrustState, T_s: float) -> bool:
    """Whether the motor signals are not trusted, and have not been good for more than a sample."""
    return logical_and(logical_not(is_trusted(x)), x.healing < 1.5 * T_s)
