"""The cost of an identified model over two of its parameters."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import RectBivariateSpline

from .identify import Identified
from .prediction import filtered

SPAN = 4.0
"""Standard deviations to either side of the answer."""

LEAST, MOST = 0.1, 3.0
"""Times the answer, within which the two stay even if they are hardly determined."""

POINTS, FINE = 7, 81
"""In each direction, at which the cost is computed, and to which a cubic spline refines it."""


@dataclass(frozen=True, eq=False)
class Surface:
    """Attributes:
    x, y: values of the two parameters, shape (POINTS,).
    cost: shape (POINTS, POINTS), x first.
    """

    x: np.ndarray
    y: np.ndarray
    cost: np.ndarray

    @property
    def fine(self) -> "Surface":
        """With a cubic spline between the points, shape (FINE, FINE)."""
        x, y = (np.linspace(each[0], each[-1], FINE) for each in (self.x, self.y))
        return Surface(x, y, RectBivariateSpline(self.x, self.y, self.cost)(x, y))


def exact(identified: Identified) -> bool:
    """Whether the cost itself is computed. For output error, which looks for the starts of all segments anew at each
    point, it is that of second order by the covariance."""
    return identified.method == "prediction error"


def curvature(identified: Identified) -> np.ndarray:
    """Second derivatives of the cost by the free parameters; next to nothing for one that the recording tells nothing
    of."""
    return np.linalg.inv(identified.covariance)


def cost_over(identified: Identified, x: str, y: str, H: np.ndarray) -> Surface:
    """How much more it is than that of the answer, as the logarithm of a likelihood with noise as large as the
    innovations are. The other free parameters follow:
    they are those with which it is least, to second order.

    Args:
        x, y: names of free parameters.
        H: `curvature`.
    """
    p, free, noise = identified.p, identified.free, identified.noise
    pair = [free.index(name) for name in (x, y)]
    others = [k for k in range(len(free)) if k not in pair]
    follow = np.eye(len(free))[:, pair]
    follow[others] = -np.linalg.solve(H[np.ix_(others, others)], H[np.ix_(others, pair)])
    least = filtered(identified.drive, p, noise)

    def cost(value_x: float, value_y: float) -> float:
        away = follow @ [value_x - getattr(p, x), value_y - getattr(p, y)]
        if not exact(identified):
            return 0.5 * float(away @ H @ away)
        there = p._replace(**{name: getattr(p, name) + by for name, by in zip(free, away, strict=True)})
        return (filtered(identified.drive, there, noise).cost - least.cost) / least.rms**2

    at_x, at_y = _about(identified, x), _about(identified, y)
    return Surface(at_x, at_y, np.array([[cost(value_x, value_y) for value_y in at_y] for value_x in at_x]))


def _about(identified: Identified, name: str) -> np.ndarray:
    value, deviation = getattr(identified.p, name), identified.deviations[name]
    lower, upper = max(value - SPAN * deviation, LEAST * value), min(value + SPAN * deviation, MOST * value)
    return np.linspace(lower, upper, POINTS)


def ellipse(identified: Identified, x: str, y: str, size: float) -> np.ndarray:
    """Where the square of the distance from the answer is `size` in the covariance of x and y, shape (2, points)."""
    pair = [identified.free.index(name) for name in (x, y)]
    turn = np.linspace(0.0, 2.0 * np.pi, 181)
    L = np.linalg.cholesky(identified.covariance[np.ix_(pair, pair)])
    centre = np.array([getattr(identified.p, name) for name in (x, y)])
    return centre[:, None] + np.sqrt(size) * L @ np.array([np.cos(turn), np.sin(turn)])
