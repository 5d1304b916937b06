"""The cost of an identified model over two of its parameters."""

import numpy as np
from scipy.interpolate import RectBivariateSpline

from .identify import Identified
from .prediction import Predictor, filtered

SPAN = 4.0
"""Standard deviations to either side of the answer."""

LEAST = 0.1
"""Times the answer, below which no parameter goes."""

POINTS, FINE = 7, 81
"""In each direction, at which the cost is computed, and to which a cubic spline refines it."""


def exact(identified: Identified) -> bool:
    """Whether the cost itself is computed. For output error, which looks for the starts of all segments anew at each
    point, it is that of second order by the covariance."""
    return identified.method == "prediction error"


def cost_over(identified: Identified, x: str, y: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """How much more it is than that of the answer, as the logarithm of a likelihood. The other free parameters follow:
    they are those with which it is least, to second order.

    Args:
        x, y: names of free parameters.

    Returns:
        Values of x and y in their units, shape (FINE,), and the cost there, shape (FINE, FINE), x first.
    """
    p, free, noise = identified.p, identified.free, identified.noise
    H = np.linalg.inv(identified.covariance)
    if exact(identified):
        H = Predictor(free).innovations(identified.drive, p, noise).information
    pair = [free.index(name) for name in (x, y)]
    others = [k for k in range(len(free)) if k not in pair]
    follow = np.eye(len(free))[:, pair]
    follow[others] = -np.linalg.solve(H[np.ix_(others, others)], H[np.ix_(others, pair)])

    def cost(value_x: float, value_y: float) -> float:
        away = follow @ [value_x - getattr(p, x), value_y - getattr(p, y)]
        if not exact(identified):
            return 0.5 * float(away @ H @ away)
        there = p._replace(**{name: getattr(p, name) + by for name, by in zip(free, away, strict=True)})
        return filtered(identified.drive, there, noise).cost - least

    least = filtered(identified.drive, p, noise).cost
    at_x, at_y = _about(identified, x, POINTS), _about(identified, y, POINTS)
    coarse = np.array([[cost(value_x, value_y) for value_y in at_y] for value_x in at_x])
    fine_x, fine_y = _about(identified, x, FINE), _about(identified, y, FINE)
    return fine_x, fine_y, RectBivariateSpline(at_x, at_y, coarse)(fine_x, fine_y)


def _about(identified: Identified, name: str, points: int) -> np.ndarray:
    value, deviation = getattr(identified.p, name), identified.deviations[name]
    return np.linspace(max(value - SPAN * deviation, LEAST * value), value + SPAN * deviation, points)


def ellipse(identified: Identified, x: str, y: str, size: float) -> np.ndarray:
    """Where the square of the distance from the answer is `size` in the covariance of x and y, shape (2, points)."""
    pair = [identified.free.index(name) for name in (x, y)]
    turn = np.linspace(0.0, 2.0 * np.pi, 181)
    L = np.linalg.cholesky(identified.covariance[np.ix_(pair, pair)])
    centre = np.array([getattr(identified.p, name) for name in (x, y)])
    return centre[:, None] + np.sqrt(size) * L @ np.array([np.cos(turn), np.sin(turn)])
