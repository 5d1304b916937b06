"""What is drawn: a car with its sensors, which follows from the seed of a campaign and its own number."""

from math import log2
from typing import NamedTuple

import numpy as np

from ...design.uncertainty_box import BOX, DOUBLINGS, LOSS, Deviation

NOISES = 1_000_000
"""Seeds of the noise are below it."""


class Draw(NamedTuple):
    """A car with its sensors.

    Attributes:
        number: from 1 on.
        noise: seed of all noise and jitter.
    """

    number: int
    deviation: Deviation
    noise: int

    def __str__(self) -> str:
        drawn = ((name, getattr(self.deviation, name)) for name in BOX)
        return f"{self.number}: {', '.join(f'{name} {value:.3g}' for name, value in drawn)}"


def draw(number: int, seed: int) -> Draw:
    """The draw of a number: uniform in the box, or in its logarithm for factors that double and halve."""
    rng = np.random.default_rng((seed, number))
    drawn = {name: _in(bounds, name in DOUBLINGS, rng) for name, bounds in BOX.items()}
    return Draw(number, Deviation(loss=LOSS, **drawn), int(rng.integers(1, NOISES)))


def _in(bounds: tuple[float, float], by_logarithm: bool, rng: np.random.Generator) -> float:
    low, high = bounds
    if by_logarithm:  # by math, as numpy's functions have other last digits on other processors
        return 2.0 ** rng.uniform(log2(low), log2(high))
    return rng.uniform(low, high)
