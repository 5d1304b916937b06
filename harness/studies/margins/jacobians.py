"""Rates of change of a function of records, by differences: exact on straight pieces, to the second order elsewhere."""

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from fmublocks.native.arithmetic import COMPUTED
from fmublocks.symbol import Symbol
from toolground.errors import UserError

STEP = 1e-4
"""By which every quantity is moved to either side, in its unit; small beside all that is not a rounding error."""

KINK = 1e-5
"""Jump of the rate, over the rate or 1, from which on a function has a kink there."""


class NotLinear(UserError):
    """A function has a kink where its rates of change are asked for; the text names the quantities."""


class Rates(NamedTuple):
    """Rates of change of some quantities (rows) over others (columns), to either side.

    Attributes:
        forward, backward: matrices (rows, columns).
        jump: what remains of their difference as the step goes to 0; of a bend without a kink nothing does.
    """

    forward: np.ndarray
    backward: np.ndarray
    jump: np.ndarray

    @property
    def mean(self) -> np.ndarray:
        return 0.5 * (self.forward + self.backward)

    @property
    def has_kink(self) -> np.ndarray:
        """Where there is a kink."""
        larger = np.maximum(np.abs(self.forward), np.abs(self.backward))
        return np.abs(self.jump) > KINK * np.maximum(larger, 1.0)


def names(record: Any, prefix: str = "") -> list[str]:
    """Names of the numbers in a record, `estimator.estimate.phi`, in their order."""
    if not isinstance(record, tuple):
        return [prefix]
    fields = getattr(type(record), "_fields", range(len(record)))
    inner = zip(fields, record, strict=True)
    return [name for field, item in inner for name in names(item, f"{prefix}.{field}" if prefix else str(field))]


def numbers(record: Any) -> list[Any]:
    """The numbers in a record, in their order."""
    return [number for item in record for number in numbers(item)] if isinstance(record, tuple) else [record]


def like(record: Any, values: Sequence[Any]) -> Any:
    """A record of the shape of another with these numbers."""
    left = iter(values)

    def made(item: Any) -> Any:
        if not isinstance(item, tuple):
            return next(left)
        return getattr(type(item), "_make", tuple)([made(inner) for inner in item])

    return made(record)


class Everywhere(Symbol):
    """A number or truth value at many points at a time, which rounds as Python does."""

    __slots__ = ("values",)

    def __init__(self, values: Any) -> None:
        self.values = values

    def after(self, operation: str, *operands: Any) -> "Everywhere":
        values = (each.values if isinstance(each, Everywhere) else each for each in operands)
        return Everywhere(AS_IN_PYTHON.get(operation, COMPUTED[operation])(*values))


AS_IN_PYTHON = {
    name: np.vectorize(getattr(math, name.lower()), otypes=[float])
    for name in ("SIN", "COS", "ATAN", "TANH", "LOG", "EXP")
}
"""Operations whose last bit numpy rounds otherwise."""


def rates(function: Callable[[Sequence[Any]], Sequence[Any]], at: Sequence[Any], columns: Sequence[int]) -> Rates:
    """Rates of change of what a function of numbers gives, over the numbers of these indices, at a point.

    The function is called with symbols (`models.block.operators`): once for all points.
    """

    steps = np.repeat([STEP, -STEP, 0.5 * STEP, -0.5 * STEP], len(columns))
    given = list(at)
    for j, k in enumerate(columns):
        values = np.full(len(steps) + 1, at[k], dtype=float)
        values[j : -1 : len(columns)] += steps[j :: len(columns)]
        given[k] = Everywhere(values)
    with np.errstate(all="ignore"):
        found = [each.values if isinstance(each, Everywhere) else each for each in function(given)]
    values = np.array([np.broadcast_to(each, len(steps) + 1) for each in found], dtype=float)
    forward, backward, half_forward, half_backward = np.split((values[:, :-1] - values[:, -1:]) / steps, 4, axis=1)
    jump = forward - backward
    refined = 2.0 * (half_forward - half_backward) - jump
    return Rates(forward, backward, np.where(np.abs(refined) < np.abs(jump), refined, jump))


def reached(moves: np.ndarray, by: np.ndarray) -> np.ndarray:
    """Which of n things change with some of them (n), be it over others.

    Args:
        moves: (n, n), whether the thing of the row changes with that of the column.
        by: these, which count themselves.
    """
    more = by | moves @ by
    return by if (more == by).all() else reached(moves, more)
