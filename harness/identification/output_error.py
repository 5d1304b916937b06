"""The parameters with which free runs of the model over short segments are nearest to the recorded motor speed.

For a car that the model does not wholly explain: there the likelihood of one-step predictions looks at what happens
within some ten milliseconds, and puts everything that the model lacks into the parameters. Each segment has its own
start, which is eliminated (G. H. Golub, V. Pereyra, Inverse Problems 19(2), 2003). A segment that starts on the wrong
flank fits badly wherever the parameters are, so that its start is looked for on both and between them.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from .drive_train import Parameters
from .maximum_likelihood import UNKNOWN, moved, scales
from .model_inputs import Drive
from .segment_simulation import Simulator

WITHIN = np.array([3.0, 10.0, 0.5])
"""Standard deviations of speeds and twist at the start of a segment about what is expected there."""

SIDES = (-1.0, 0.0, 1.0)
"""Twists at which the search for a start begins, in half gaps."""

SIGMA = 1.0
"""What the motor speed is off by in rad/s, about."""

OF_START = (0, 1, 2, 4)
"""What of the state each segment has for itself: speeds, twist and load offset."""

O_T = 1.5
"""Standard deviation in N.m within which the offset of the motor torque is looked for."""

AS_GOOD, OTHER = 1.15, 1.5
"""Error of a fit over that of the best up to which it is about as good, and ratio of J_2 or C from which on it is
another one."""

ENOUGH = 1e-4
"""Share of its cost that a step must promise to gain for the search to go on."""

ENOUGH_OF_START = 1e-5
"""The same for the start of a segment."""


@dataclass(frozen=True, eq=False)
class Fitted:
    """Attributes:
    p: the parameters.
    free: names of those that were fitted.
    o_T: offset of the motor torque in N.m.
    starts: omega_1, omega_2, phi, o_L of each segment, shape (segments, 4).
    covariance: of the free parameters: what the segments say about them, each for itself (sandwich).
    error: rms of the motor speed in rad/s.
    """

    p: Parameters
    free: tuple[str, ...]
    o_T: float
    starts: np.ndarray
    covariance: np.ndarray
    error: float

    def deviation(self, name: str) -> float:
        """Standard deviation of a free parameter, in its unit."""
        k = self.free.index(name)
        return float(np.sqrt(self.covariance[k, k]))


def rivals(best: Fitted, other: Fitted) -> bool:
    """Whether free runs fit about as well with quite other parameters."""
    ratios = [getattr(other.p, name) / getattr(best.p, name) for name in ("J_2", "C")]
    return other.error < AS_GOOD * best.error and max(*ratios, *(1.0 / ratio for ratio in ratios)) > OTHER


def covariance_with_rival(best: Fitted, other: Fitted) -> np.ndarray:
    """Covariance of the free parameters about the best fit, allowing for a rival, as likely as that."""
    if not rivals(best, other):
        return best.covariance
    off = np.array([getattr(other.p, name) - getattr(best.p, name) for name in best.free])
    return best.covariance + 0.5 * np.outer(off, off)


@dataclass(frozen=True, eq=False)
class _Point:
    """Where the search is, and the starts that are expected."""

    p: Parameters
    o_T: float
    starts: np.ndarray
    expected: np.ndarray


@dataclass(frozen=True, eq=False)
class _Linear:
    """The problem about a point, starts eliminated: cost, its Hessian, the share of each segment in its gradient, and
    how the starts follow the common unknowns, o_T first."""

    cost: float
    H: np.ndarray
    scores: np.ndarray
    follow: np.ndarray


class Segments:
    """A recording in segments.

    Args:
        length: of a segment in samples.
        free: names of the parameters to be fitted.
        drift: standard deviation in N.m of the load offset from segment to segment.
        first: sample at which the first segment begins.
    """

    def __init__(self, drive: Drive, length: int, free: Sequence[str], drift: float, first: int = 0) -> None:
        self.drive, self.length, self.free = drive, length, tuple(free)
        self.firsts = range(first, len(drive) - length + 1, length)
        self.simulator, self.starting = Simulator(length, free), Simulator(length)
        self.priors = 1.0 / np.square([*WITHIN, drift])

    def fit(self, p: Parameters, starts: np.ndarray, most: int = 30) -> Fitted:
        """
        Args:
            p: to begin with.
            starts: those that are expected of the segments, shape (segments, 4).
            most: steps.
        """
        now = _Point(p, 0.0, starts, starts)
        now = replace(now, starts=self.found(now, anywhere=True))
        now, linear = self._descend(now, most // 2)
        starts = self.found(now, anywhere=True)
        now, linear = self._descend(replace(now, starts=starts, expected=starts), most - most // 2)
        inverse = np.linalg.inv(linear.H)
        n, m = linear.scores.shape
        covariance = inverse @ (linear.scores.T @ linear.scores) @ inverse * n / max(n - m, 1)
        error = SIGMA * np.sqrt(2.0 * linear.cost / (n * self.length))
        return Fitted(now.p, self.free, now.o_T, now.starts, covariance[1:, 1:], float(error))

    def free_runs(self, p: Parameters, starts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """States of runs from the best starts, shape (segments, length, states), and the recorded motor speed in rad/s,
        shape (segments, length)."""
        found = self.found(_Point(p, 0.0, starts, starts), anywhere=True)
        begins = [np.array([*start[:3], 0.0, start[3]]) for start in found]
        runs = [self.starting.run(self.drive, first, x, p) for first, x in zip(self.firsts, begins, strict=True)]
        recorded = [self.drive.omega_1[first + 1 : first + 1 + self.length] for first in self.firsts]
        return np.array(runs), np.array(recorded)

    def _descend(self, now: _Point, most: int) -> tuple[_Point, _Linear]:
        linear, trust = self._linear(now), 1e-3
        for _ in range(most):
            scale = np.concatenate([[1.0], scales(now.p, self.free)])
            H, g = linear.H * np.outer(scale, scale), linear.scores.sum(axis=0) * scale
            step = np.clip(-np.linalg.solve(H + trust * np.diag(np.diag(H)), g), -0.5, 0.5)
            if -(g + 0.5 * H @ step) @ step < ENOUGH * linear.cost:
                break
            starts = now.starts + linear.follow @ (scale * step)
            tried = _Point(moved(now.p, self.free, step[1:]), now.o_T + step[0], starts, now.expected)
            tried = replace(tried, starts=self.found(tried))
            after = self._linear(tried)
            if after.cost < linear.cost:
                now, linear, trust = tried, after, max(trust / 5.0, 1e-9)
            else:
                trust = max(10.0 * trust, 1.0)
        return now, linear

    def _residuals(
        self, simulator: Simulator, k: int, start: np.ndarray, at: _Point
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """What the motor speed is off by in segment k over SIGMA, and its derivatives by start and common unknowns."""
        first = self.firsts[k]
        x, d = simulator.run_with_derivatives(self.drive, first, np.array([*start[:3], at.o_T, start[3]]), at.p)
        r = x[:, 0] - self.drive.omega_1[first + 1 : first + 1 + self.length]
        d = d[:, 0] / SIGMA
        return r / SIGMA, d[:, OF_START], np.delete(d, OF_START, axis=1)

    def _linear(self, at: _Point) -> _Linear:
        m = 1 + len(self.free)
        H = np.diag([1.0 / O_T**2, *(UNKNOWN / scales(at.p, self.free) ** 2)])
        scores, follow, cost = [], [], 0.5 * (at.o_T / O_T) ** 2
        for k, start in enumerate(at.starts):
            r, A, B = self._residuals(self.simulator, k, start, at)
            E = np.linalg.solve(A.T @ A + np.diag(self.priors), A.T @ B)
            off = A.T @ r + self.priors * (start - at.expected[k])
            H += (B - A @ E).T @ B
            scores.append(B.T @ r - E.T @ off + [at.o_T / O_T**2 / len(at.starts), *np.zeros(m - 1)])
            follow.append(-E)
            cost += self._cost(r, start, at.expected[k])
        return _Linear(cost, H, np.array(scores), np.array(follow))

    def found(self, at: _Point, anywhere: bool = False) -> np.ndarray:
        """The starts that fit best."""
        starts = []
        for k, near in enumerate(at.starts):
            best = self._start(k, near, at)
            if anywhere:
                others = [np.array([*near[:2], side * 1.5 * at.p.phi_B, near[3]]) for side in SIDES]
                best = min([best, *(self._start(k, other, at) for other in others)], key=lambda found: found[1])
            starts.append(best[0])
        return np.array(starts)

    def _start(self, k: int, start: np.ndarray, at: _Point, most: int = 8) -> tuple[np.ndarray, float]:
        expected, trust = at.expected[k], 1e-3
        r, A, _ = self._residuals(self.starting, k, start, at)
        cost = self._cost(r, start, expected)
        for _ in range(most):
            H, g = A.T @ A + np.diag(self.priors), A.T @ r + self.priors * (start - expected)
            step = -np.linalg.solve(H + trust * np.diag(np.diag(H)), g)
            if -(g + 0.5 * H @ step) @ step < ENOUGH_OF_START * cost:
                break
            off, A_tried, _ = self._residuals(self.starting, k, start + step, at)
            if (tried := self._cost(off, start + step, expected)) < cost:
                start, r, A, cost, trust = start + step, off, A_tried, tried, trust / 5.0
            else:
                trust = max(10.0 * trust, 1.0)
        return start, cost

    def _cost(self, r: np.ndarray, start: np.ndarray, expected: np.ndarray) -> float:
        """Of a segment."""
        return 0.5 * float(r @ r + self.priors @ (start - expected) ** 2)
