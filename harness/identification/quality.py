"""How well an identified model fits a recording: simulated over 0.5 s, predicted over a sample and over 50 ms."""

from dataclasses import dataclass

import numpy as np
from scipy.stats import norm

from .drive_train import Parameters
from .model_inputs import Drive
from .output_error import Segments
from .prediction import BURN_IN, Filtered, Noise, filtered
from .segment_simulation import Simulator

SIMULATED, PREDICTED = 0.5, 0.05
"""In s."""

Z_95 = float(norm.ppf(0.975))
"""Standard deviations within which 95 % of what is normal are."""


@dataclass(frozen=True)
class Quality:
    """Fits in %: 100 (1 - rms error/standard deviation of the motor speed), the NRMSE of the field.

    Attributes:
        simulated: over SIMULATED, from the start that fits best.
        one_step: predicted by the filter over a sample.
        predicted: over PREDICTED, from the state of the filter.
        size: rms of the innovations, 1 where model and noise are right.
        correlation: largest autocorrelation of the innovations up to PREDICTED apart, near 0 if they are white.
    """

    simulated: float
    one_step: float
    predicted: float
    size: float
    correlation: float


def nrmse(error: np.ndarray, signal: np.ndarray) -> float:
    """In %."""
    return 100.0 * (1.0 - float(np.sqrt(np.mean(error**2)) / signal.std()))


def segments(drive: Drive, free: tuple[str, ...], drift: float, first: int = 0) -> Segments:
    """The recording in pieces of SIMULATED.

    Args:
        drift: see `Segments`.
        first: sample from which on; at least BURN_IN is left out.
    """
    first = max(first, round(BURN_IN / drive.T_s))
    return Segments(drive, round(SIMULATED / drive.T_s), free, drift, first)


def near_starts(pieces: Segments, through: Filtered) -> np.ndarray:
    """The starts of the pieces as the filter sees them, shape (pieces, 4): speeds, twist, offset of the load."""
    return np.array([through.states[first - 1, [0, 1, 2, 4]] for first in pieces.firsts])


def judged(drive: Drive, p: Parameters, noise: Noise, drift: float, first: int) -> Quality:
    """
    Args:
        drift: see `Segments`.
        first: sample from which on it is judged; the filter begins before.
    """
    through, after = filtered(drive, p, noise), round(PREDICTED / drive.T_s)
    ahead = Simulator(after)
    begins = range(first, len(drive) - after, max(after // 5, 1))
    errors = [ahead.run(drive, k, through.states[k - 1], p)[-1, 0] - drive.omega_1[k + after] for k in begins]
    pieces = segments(drive, (), drift, first)
    simulated, recorded = pieces.free_runs(p, near_starts(pieces, through))
    size = through.size[first : through.counted.stop]
    return Quality(
        nrmse(simulated[..., 0] - recorded, recorded),
        nrmse(through.errors[first:], drive.omega_1[first + 1 :]),
        nrmse(np.array(errors), drive.omega_1[first + after :]),
        float(np.sqrt(np.mean(size**2))),
        max((autocorrelation(size, lag) for lag in range(1, after + 1)), key=abs),
    )


def autocorrelation(x: np.ndarray, lag: int) -> float:
    """Of samples so many apart; 1 if they are the same."""
    x = x - x.mean()
    return float(x[lag:] @ x[:-lag] / (x @ x))
