"""Trust in the motor signals: lost by one of the causes, got back when it has healed; and the direction of the car.

While there is trust, a clock runs for each time after which causes count (t_bad, t_apart), as long as one of these is
found. Without trust, the first of them runs as long as nothing is found, until trust is back.

A wheel speed has no sign. The direction of the car is that which the bus tells, else that in which it is driven out of
rest; out of a start that is only taken for rest until the motor turns. Its magnitude says how sure it is: it grows for
t_apart as the motor turns, and the other way it shrinks as slowly, since wheels that lock throw the motor back for
about as long. While it is not sure that goes on without trust, so that a start with any signals heals.
"""

from collections.abc import Mapping
from functools import reduce
from typing import Annotated, NamedTuple

from fmublocks.block.declaration import Real
from fmublocks.block.operators import logical_and, logical_not, logical_or, maximum, minimum, where

from .causes import CLOCKS, NONE, first_of
from .supervision_interface import Input, Parameters


class TrustState(NamedTuple):
    """The cause of the fallback, for how long the signals have spoken against it, and the direction."""

    cause: Annotated[int, Real("1", "number of the cause, that of none while the motor signals are trusted")]
    clock: Annotated[float, Real("s", "time for which motor signals have been bad, or good where there is a cause")]
    apart: Annotated[float, Real("s", "time for which the motor speed has been contradicted")]
    direction: Annotated[
        float, Real("1", "of the car, 1 forwards, -1 backwards, between them as far as it is not sure")
    ]


def start() -> TrustState:
    return TrustState(NONE, 0.0, 0.0, 0.0)


def is_trusted(x: TrustState) -> bool:
    return x.cause == NONE


def direction(
    x: TrustState, u: Input, sure: bool, pushed: bool, omega_1: float, good: bool, T_s: float, p: Parameters
) -> float:
    """Of the car in this sample.

    Args:
        sure: whether the demand tells it: it has ended a rest that was seen, or the motor has set off against it.
        pushed: whether a demand has ended what was taken for rest, which tells it until the motor turns.
        omega_1: motor speed, rad/s.
        good: whether that is good.
    """
    step, towards, demanded = T_s / p.t_apart, sign_of(omega_1), sign_of(u.T_driver)
    unsure = x.direction * towards < 1.0
    turning = logical_and(logical_and(unsure, good), abs(omega_1) > p.omega_still)
    turning = logical_and(turning, logical_or(is_trusted(x), abs(x.direction) < 1.0))
    along = x.direction * towards + step
    seen = where(turning, towards * minimum(where(along >= 0.0, maximum(along, step), along), 1.0), x.direction)
    seen = where(sure, demanded, where(pushed, step * demanded, seen))
    return where(u.direction > 0, 1.0, where(u.direction < 0, -1.0, seen))


def sign_of(value: float) -> float:
    """1 for what is forwards, also for what is not sure at all, -1 for what is backwards."""
    return where(value >= 0.0, 1.0, -1.0)


def update(x: TrustState, failures: Mapping[int, bool], turned: bool, T_s: float, p: Parameters) -> TrustState:
    """The state after one sample, whose direction it has already.

    Args:
        found: whether what a row of FAILURES is about was found, by its number.
        turned: whether the motor turns the other way.
    """
    clocks = {"t_bad": x.clock + T_s, "t_apart": x.apart + T_s}
    firsts = {after: first_of({number: failures[number] for number in rows}) for after, rows in CLOCKS.items()}
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
