"""Rates of change of a function of records, by differences: exact on straight pieces, to the second order elsewhere."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ...base.errors import DrivelineError

STEP = 1e-4
"""By which every quantity is moved to either side, in its unit; small beside all that is not a rounding error."""

KINK = 1e-5
"""Jump of the rate, over the rate or 1, from which on a function has a kink there."""


class NotLinear(DrivelineError):
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


def rates(function: Callable[[Sequence[Any]], Sequence[Any]], at: Sequence[Any], columns: Sequence[int]) -> Rates:
    """Rates of change of what a function of numbers gives, over the numbers of these indices, at a point."""
    here = np.array(function(at), dtype=float)

    def moved(k: int, step: float) -> np.ndarray:
        there = list(at)
        there[k] += step
        return (np.array(function(there), dtype=float) - here) / step

    def sides(step: float) -> tuple[np.ndarray, np.ndarray]:
        empty = np.zeros((len(here), 0))
        forward, backward = (np.column_stack([empty, *(moved(k, h) for k in columns)]) for h in (step, -step))
        return forward, backward

    forward, backward = sides(STEP)
    found = Rates(forward, backward, jump=forward - backward)
    if not found.has_kink.any():
        return found
    half_forward, half_backward = sides(0.5 * STEP)
    return found._replace(jump=2.0 * (half_forward - half_backward) - found.jump)
