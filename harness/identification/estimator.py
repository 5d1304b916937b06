"""The most likely parameters, with what is known of them before: scoring steps with a trust that adapts (Levenberg,
Marquardt), within physical bounds."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.stats import norm

from driverecords.thresholds import Threshold

from .drive_train import Parameters
from .prediction import CHANNELS, Noise, Predicted, Predictor
from .priors import LEAST, PRIORS, before, moved, scales, surprise

Z_95 = float(norm.ppf(0.975))
"""Standard deviations within which 95 % of what is normal are."""


DIFFERENCES = (1e-4, 3e-3)
"""Least and largest step of the derivatives, of what is searched; between them half a standard deviation. With much
smaller ones a few samples at which the filter hesitates stop the search: a skew was found .2 ms off so."""

HESITATES = 5.0
"""Derivative over its 99 % quantile beyond which it is cut off: where the filter hesitates between flanks, single
samples have thousands of times the usual one, and would be taken for knowledge."""

LARGEST = 0.7
"""Step of the search: a factor of 2."""

ENOUGH = 0.02
"""Gain in likelihood, and step in standard deviations, at which the search has ended: a tenth of an interval is .2."""

WINDOW = 0.1
"""Time in s of a window of the sandwich: beyond it innovations of the validation vehicle no longer go together."""

LINEARISED = 1.15
"""Times the deviations that the likelihood tells: the filter linearises the flanks of the gap. In drives of foreign
loops the skew of the load scatters by 1.12 times that, all else by less."""

UNTOLD = Threshold(
    0.5,
    "1",
    "standard deviation over that of before, of what is not told",
    "three quarters of it are from the recording then",
)


@dataclass(frozen=True, eq=False)
class Found:
    """Where a search has ended.

    Attributes:
        p: the parameters.
        free: names of those that were searched.
        centre: what was expected before.
        predicted: with them.
        scores: derivatives of the cost by what is searched, shape (samples, free).
        information: Fisher's, of each channel, shape (2, free, free).
        noise: of the sensors.
        T_s: between samples in s.
        passes: through the recording.
        off: standard deviations of parameters, in their units, beside those of the likelihood.
    """

    p: Parameters
    free: tuple[str, ...]
    centre: Parameters
    predicted: Predicted
    scores: np.ndarray
    information: np.ndarray
    noise: Noise
    T_s: float
    passes: int
    off: Mapping[str, float] = field(default_factory=dict)

    @cached_property
    def scale(self) -> np.ndarray:
        """Derivative of each free parameter by what is searched."""
        return scales(self.p, self.free)

    @cached_property
    def covariance(self) -> np.ndarray:
        """Of the free parameters, in their units: that of the likelihood and LINEARISED, each deviation as much larger
        as the scores of windows scatter more than noise alone (sandwich); and what else they are off by."""
        inverse = np.linalg.inv(self.information.sum(axis=0) + np.diag(before(self.free)))
        windows = max(round(len(self.scores) * self.T_s / WINDOW), 2)
        scores = np.array([part.sum(axis=0) for part in np.array_split(self.scores, windows)])
        scores -= scores.mean(axis=0)
        sandwich = inverse @ (scores.T @ scores) @ inverse * windows / (windows - 1)
        wider = LINEARISED * np.sqrt(np.maximum(np.diag(sandwich) / np.diag(inverse), 1.0)) * self.scale
        return inverse * np.outer(wider, wider) + np.diag([self.off.get(name, 0.0) ** 2 for name in self.free])

    @cached_property
    def deviations(self) -> dict[str, float]:
        """Standard deviation of each free parameter, in its unit."""
        return dict(zip(self.free, map(float, np.sqrt(np.diag(self.covariance))), strict=True))

    def told_by(self, name: str) -> str:
        """The channel that alone tells most of a parameter; "" where the recording tells nothing of it."""
        k, prior = self.free.index(name), np.diag(before(self.free))
        if np.sqrt(self.covariance[k, k]) > UNTOLD * PRIORS[name].deviation * self._unit(name):
            return ""
        alone = [np.linalg.inv(of + prior)[k, k] for of in self.information]
        return CHANNELS[int(np.argmin(alone))]

    def _unit(self, name: str) -> float:
        return getattr(self.p, name) if PRIORS[name].positive else 1.0


def _without_hesitation(derivatives: np.ndarray) -> np.ndarray:
    most = HESITATES * np.quantile(np.abs(derivatives), 0.99, axis=-1, keepdims=True)
    return np.clip(derivatives, -most, most)


def search(predictor: Predictor, start: Parameters, free: Sequence[str], centre: Parameters, most: int = 40) -> Found:
    """
    Args:
        free: names of the parameters that are searched.
        centre: what is expected before.
        most: steps.
    """
    free, at, drive = tuple(free), predictor.start(start), predictor.drive
    weight, counted = before(free), predictor.counted

    def cost(p: Parameters, predicted: Predicted) -> float:
        return predicted.cost + 0.5 * float(weight @ surprise(p, free, centre) ** 2)

    differences = np.full(len(free), DIFFERENCES[0])

    def estimate_at(p: Parameters, predicted: Predicted, passes: int) -> Found:
        """With the derivatives there."""
        d_size, d_log = np.empty((2, 2, len(free), *predicted.size[:, counted].shape[1:]))
        for k in range(len(free)):
            moved_on = predictor.predicted(moved(p, free, differences[k] * np.eye(len(free))[k]), at)
            d_size[:, k] = (moved_on.size - predicted.size)[:, counted] / differences[k]
            d_log[:, k] = (moved_on.log_S - predicted.log_S)[:, counted] / differences[k]
        d_size, d_log = _without_hesitation(d_size), _without_hesitation(d_log)
        scores = np.einsum("ckn,cn->nk", d_size, predicted.size[:, counted]) + 0.5 * d_log.sum(axis=0).T
        # a half of what the variance tells is in d_size
        information = np.array([a @ a.T + 0.25 * b @ b.T for a, b in zip(d_size, d_log, strict=True)])
        differences[:] = np.clip(0.5 / np.sqrt(np.diag(information.sum(axis=0)) + weight), *DIFFERENCES)
        return Found(p, free, centre, predicted, scores, information, predictor.noise, drive.T_s, passes, drive.off)

    predicted = predictor.predicted(start, at)
    best, lowest, trust = estimate_at(start, predicted, 1), cost(start, predicted), 1e-2
    for passes in range(2, most + 1):
        g = best.scores.sum(axis=0) + weight * surprise(best.p, free, centre)
        # what is at its bound stays there if the recording would have it beyond
        bounded = [getattr(best.p, name) <= LEAST.get(name, -np.inf) for name in free]
        inside = ~(np.array(bounded) & (g > 0.0))
        H = best.information.sum(axis=0) + np.diag(weight)
        part = H[np.ix_(inside, inside)]
        step = np.zeros(len(free))
        step[inside] = -np.linalg.solve(part + trust * np.diag(np.diag(part)), g[inside])
        step = np.clip(step, -LARGEST, LARGEST)
        if np.sqrt(step @ H @ step / len(free)) < ENOUGH:
            break
        p = moved(best.p, free, step)
        predicted = predictor.predicted(p, at)
        now = cost(p, predicted)
        if np.isfinite(now) and now < lowest:
            gain, lowest, trust = lowest - now, now, max(trust / 10.0, 1e-9)
            best = estimate_at(p, predicted, passes)
            if gain < ENOUGH:
                break
        else:
            trust = max(10.0 * trust, 1.0)
    return best
