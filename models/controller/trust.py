"""Trust in the motor signals: lost by one of the causes, got back when it has healed; and the direction of the car.

While there is trust, a clock runs for each time after which causes count (t_bad, t_apart), as long as one of these is
found. Without trust, the first of them runs as long as nothing is found, until trust is back.

A wheel speed has no sign. The direction of the car is that which the bus tells, else that in which it is driven out of
rest. A motor that turns the other way turns it round within t_apart, which goes on if trust is lost meanwhile: at once
would be too soon, as wheels that lock throw the motor back for about as long.
"""

from collections.abc import Mapping
from functools import reduce
from typing import Annotated, NamedTuple

from ..block.declaration import Real
from ..block.operators import logical_and, logical_not, logical_or, where
from .causes import CLOCKS, NONE, first_of
from .supervision_interface import Input, Parameters


class TrustState(NamedTuple):
    """The cause of the fallback, for how long the signals have spoken against it, and the direction."""

    cause: Annotated[int, Real("1", "number of the cause, that of none while the motor signals are trusted")]
    clock: Annotated[float, Real("s", "time for which motor signals have been bad, or good where there is a cause")]
    apart: Annotated[float, Real("s", "time for which the motor speed has been contradicted")]
    direction: Annotated[float, Real("1", "of the car, 1 forwards, -1 backwards, between them as it turns round")]


def start(omega_1: float, p: Parameters) -> TrustState:
    return TrustState(NONE, 0.0, 0.0, where(omega_1 < -p.omega_still, -1.0, 1.0))


def is_trusted(x: TrustState) -> bool:
    return x.cause == NONE


def direction(x: TrustState, u: Input, pushed: bool, omega_1: float, good: bool, T_s: float, p: Parameters) -> float:
    """Of the car in this sample: of the demand where that has `pushed` it, else of the motor speed (rad/s) if good."""
    turning = logical_and(good, abs(omega_1) > p.omega_still)
    turning = logical_and(turning, logical_or(is_trusted(x), abs(x.direction) < 1.0))
    towards = sign_of(where(pushed, u.T_driver, omega_1))
    later = x.direction + T_s / p.t_apart * towards
    later = where(logical_or(pushed, later * towards >= 0.0), towards, later)
    seen = where(logical_or(pushed, turning), later, x.direction)
    return where(u.direction > 0, 1.0, where(u.direction < 0, -1.0, seen))


def sign_of(value: float) -> float:
    """1 for what is forwards, -1 for what is not."""
    return where(value > 0.0, 1.0, -1.0)


def update(x: TrustState, found: Mapping[int, bool], turned: bool, T_s: float, p: Parameters) -> TrustState:
    """The state after one sample, whose direction it has already.

    Args:
        found: whether what a row of FAILURES is about was found, by its number.
        turned: whether the motor turns the other way.
    """
    clocks = {"t_bad": x.clock + T_s, "t_apart": x.apart + T_s}
    firsts = {after: first_of({number: found[number] for number in rows}) for after, rows in CLOCKS.items()}
    lost = NONE
    for after, first in reversed(firsts.items()):
        counts = logical_and(first != NONE, clocks[after] > getattr(p, after)) if after else first != NONE
        lost = where(counts, first, lost)
    trusted, bad, apart = is_trusted(x), firsts["t_bad"] != NONE, firsts["t_apart"] != NONE
    good = reduce(logical_and, (first == NONE for first in firsts.values()), logical_not(trusted))
    healed = logical_and(good, clocks["t_bad"] >= where(turned, p.t_turn, p.t_proof) - 0.5 * T_s)
    cause = where(trusted, lost, where(healed, NONE, x.cause))
    return x._replace(
        cause=cause,
        clock=where(logical_and(logical_or(good, logical_and(trusted, bad)), cause == x.cause), clocks["t_bad"], 0.0),
        apart=where(logical_and(cause == NONE, apart), clocks["t_apart"], 0.0),
    )


def is_healing(x: TrustState, T_s: float) -> bool:
    """Whether the motor signals are not trusted, and have not been good for more than a sample."""
    one_sample = 1.5 * T_s  # half a sample of room for sums of T_s
    return logical_and(logical_not(is_trusted(x)), x.clock < one_sample)
