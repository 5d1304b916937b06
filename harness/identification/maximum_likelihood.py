"""The parameters under which the innovations are likeliest, by scoring steps with a trust in them that adapts
(Levenberg, Marquardt). Positive parameters are searched by their logarithm."""

from collections.abc import Container, Sequence
from dataclasses import dataclass

import numpy as np

from .drive_train import DELAYS, Parameters
from .model_inputs import Drive
from .prediction import Innovations, Noise, Predictor
from .time_shifts import MOST

SIGNED = {"d": 1.0, **dict.fromkeys(DELAYS, 1e-3)}
"""Parameters that may be zero; they are searched as they are, in these units."""

UNKNOWN = 1e-4
"""Information that is added about all that is searched. What the recording tells nothing of (a gap that is not crossed)
so remains as it was, with a standard deviation of 100 times its value."""

ENOUGH = 0.02
"""Step in standard deviations at which the search has ended."""

GAIN = 0.02
"""The same as what a step has gained in likelihood, with noise as large as the innovations are."""


@dataclass(frozen=True, eq=False)
class Found:
    """Attributes:
    p: the parameters.
    free: names of those that were searched.
    innovations: with them.
    passes: through the recording.
    """

    p: Parameters
    free: tuple[str, ...]
    innovations: Innovations
    passes: int

    @property
    def inverse_information(self) -> np.ndarray:
        """Of the free parameters."""
        scale = scales(self.p, self.free)
        return np.outer(scale, scale) * np.linalg.inv(_information(self.innovations, scale))

    @property
    def covariance(self) -> np.ndarray:
        """Of the free parameters, if the innovations are white, and noise as large as they are."""
        return self.inverse_information * self.innovations.rms**2

    @property
    def deviations(self) -> dict[str, float]:
        """Standard deviation of each free parameter, in its unit."""
        return dict(zip(self.free, map(float, np.sqrt(np.diag(self.covariance))), strict=True))

    def gain(self, other: "Found") -> float:
        """Twice what another one gains in likelihood, with noise as large as these innovations are."""
        return 2.0 * (self.innovations.cost - other.innovations.cost) / self.innovations.rms**2


def deviations_if_known(covariance: np.ndarray, free: Sequence[str], known: Container[str]) -> dict[str, float]:
    """Standard deviations of the free parameters, if those of these names were known.

    Args:
        covariance: of the free ones, in their order.
    """
    rest = [k for k, name in enumerate(free) if name not in known]
    information = np.linalg.inv(covariance)[np.ix_(rest, rest)]
    return dict(zip([free[k] for k in rest], map(float, np.sqrt(np.diag(np.linalg.inv(information)))), strict=True))


def _information(innovations: Innovations, scale: np.ndarray) -> np.ndarray:
    """Of what is searched."""
    return innovations.information * np.outer(scale, scale) + UNKNOWN * np.eye(len(scale))


def scales(p: Parameters, free: Sequence[str]) -> np.ndarray:
    """Derivative of each free parameter by what is searched."""
    return np.array([SIGNED.get(name) or getattr(p, name) for name in free])


def moved(p: Parameters, free: Sequence[str], by: np.ndarray) -> Parameters:
    values = {
        name: getattr(p, name) + SIGNED[name] * step if name in SIGNED else getattr(p, name) * float(np.exp(step))
        for name, step in zip(free, by, strict=True)
    }
    values |= {name: float(np.clip(values[name], -MOST, MOST)) for name in DELAYS if name in values}
    return p._replace(**values)


def maximise(
    predictor: Predictor,
    drive: Drive,
    start: Parameters,
    noise: Noise,
    most: int = 30,
) -> Found:
    free, trust = predictor.free, 1e-2
    p, best = start, predictor.innovations(drive, start, noise)
    passes = 1
    while passes < most:
        scale = scales(p, free)
        H, g = _information(best, scale), best.gradient * scale
        step = -np.linalg.solve(H + trust * np.diag(np.diag(H)), g)
        step = np.clip(step, -0.7, 0.7)
        if np.sqrt(step @ H @ step / len(free)) < ENOUGH:
            break
        tried_p = moved(p, free, step)
        tried = predictor.innovations(drive, tried_p, noise)
        passes += 1
        if np.isfinite(tried.cost) and tried.cost < best.cost:
            gain, p, best, trust = best.cost - tried.cost, tried_p, tried, max(trust / 10.0, 1e-9)
            if gain < GAIN * best.rms**2:
                break
        else:
            trust = max(10.0 * trust, 1.0)
    return Found(p, free, best, passes)
