"""Signals as functions of time: what a manoeuvre gives the loop from outside.

A signal takes instants in s and gives the values there. At a jump it already has the new value. Instants are
taken as whole nanoseconds, so that `k * step_size` meets a jump whatever the rounding of the product.

Signals are plain data until they are evaluated; numpy is imported only then, because help and completion of the
command line need no more than the names of the manoeuvres.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike

Signal = Callable[[Any], "np.ndarray"]


def nanoseconds(t: ArrayLike) -> np.ndarray:
    """t in s, rounded to whole nanoseconds."""
    import numpy as np

    return np.round(np.asarray(t, dtype=float), 9)


@dataclass(frozen=True, eq=False)
class Lines:
    """Straight lines between points, held beyond both ends; two points at one instant are a jump."""

    times: Sequence[float] | np.ndarray
    values: Sequence[float] | np.ndarray

    def __call__(self, t: ArrayLike) -> np.ndarray:
        import numpy as np

        return np.asarray(np.interp(nanoseconds(t), self.times, self.values))

    def before(self, t: ArrayLike) -> np.ndarray:
        """Its values up to the instants, where it jumps the old ones."""
        import numpy as np

        return np.interp(-nanoseconds(t), -np.asarray(self.times)[::-1], np.asarray(self.values)[::-1])


@dataclass(frozen=True, eq=False)
class Held:
    """values[k] from k * interval on; the first and the last value are held beyond the ends."""

    interval: float
    values: Sequence[float] | np.ndarray

    def __call__(self, t: ArrayLike) -> np.ndarray:
        import numpy as np

        k = np.floor(nanoseconds(t) / self.interval + 1e-6).astype(int)
        return np.asarray(self.values, dtype=float)[np.clip(k, 0, len(self.values) - 1)]


@dataclass(frozen=True)
class Count:
    """The whole part of lines: a counter that goes on between the instants at which it was seen."""

    lines: Lines

    def __call__(self, t: ArrayLike) -> np.ndarray:
        import numpy as np

        return np.floor(self.lines(t) + 1e-6)


@dataclass(frozen=True)
class FlatSine:
    """A sine of the frequency (Hz) about a mean, its flanks `steepness` times as steep, cut off at the amplitude."""

    mean: float
    amplitude: float
    frequency: float
    steepness: float

    def __call__(self, t: ArrayLike) -> np.ndarray:
        import numpy as np

        sine = np.sin(2.0 * np.pi * self.frequency * np.asarray(t, dtype=float))
        return self.mean + self.amplitude * np.clip(self.steepness * sine, -1.0, 1.0)


def lines(*points: tuple[float, float]) -> Lines:
    """The signal through the points (t in s, value)."""
    return Lines(tuple(float(t) for t, _ in points), tuple(float(value) for _, value in points))


NOTHING = lines((0.0, 0.0))
