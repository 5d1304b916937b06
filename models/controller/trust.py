"""Trust in the motor signals: lost by one of the causes, got back when it has healed."""

from collections.abc import Mapping
from typing import Annotated, Any, NamedTuple

from ..block.declaration import Real
from ..block.operators import logical_and, logical_not, logical_or, minimum, where
from .causes import FAILURES, NONE
from .supervision_interface import Parameters


class TrustState(NamedTuple):
    """The cause of the fallback, and how far it has healed."""

    cause: Annotated[int, Real("1", "number of the cause, that of none while the motor signals are trusted")]
    healing: Annotated[float, Real("s", "time for which the motor signals have been good")]


class Found(NamedTuple):
    """What was found of a cause in a sample.

    Attributes:
        now: whether.
        lasting: for how long, s.
    """

    now: bool
    lasting: float


def start() -> TrustState:
    return TrustState(NONE, 0.0)


def is_trusted(x: TrustState) -> bool:
    return x.cause == NONE


def update(
    x: TrustState,
    found: Mapping[int, Found],
    confirmed: bool,
    turned: bool,
    resting: bool,
    T_s: float,
    p: Parameters,
) -> TrustState:
    """The state after one sample.

    Args:
        found: by the number of the cause.
        confirmed: whether the wheel speed is there, and agrees.
        turned: whether the motor turns the other way than before.
        resting: whether the car is at rest.
    """
    limits: Any = p
    cause, good, latched = x.cause, True, False
    for row in reversed(FAILURES):
        now, lasting = found[row.number]
        fails = now if row.after is None else logical_and(now, lasting > getattr(limits, row.after))
        cause = where(logical_and(fails, True if row.latched else is_trusted(x)), row.number, cause)
        good = logical_and(good, logical_not(now))
        latched = logical_or(latched, logical_and(cause == row.number, row.latched))
    proving = logical_and(good, logical_or(logical_not(latched), logical_or(confirmed, resting)))
    healing = where(proving, minimum(x.healing + T_s, p.t_turn), 0.0)
    healed = healing >= where(turned, p.t_turn, p.t_proof) - 0.5 * T_s
    return TrustState(cause=where(healed, NONE, cause), healing=healing)
