"""How certain a frequency response is, and that of the recording itself."""

import numpy as np
from scipy.signal import csd, welch

from .drive_train_response import WINDOW, Tyre, response
from .identify import Identified

DRAWS = 500

PERCENTILES = (2.5, 97.5)
"""Between which the band lies."""


def drawn_responses(identified: Identified, frequencies: np.ndarray, behind: Tyre | None, seed: int) -> np.ndarray:
    """omega_1/T_mot of parameters drawn from the covariance, the tyre as it is, shape (DRAWS, frequencies).

    Args:
        frequencies: in Hz.
        behind: what hangs on the wheels.
    """
    p, free = identified.p, identified.free
    drawn = np.random.default_rng(seed).multivariate_normal([getattr(p, x) for x in free], identified.covariance, DRAWS)
    others = [p._replace(**dict(zip(free, map(float, values), strict=True))) for values in drawn]
    return np.array([response(other, frequencies, behind) for other in others])


def recorded_response(identified: Identified) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies in Hz and omega_1/T_mot there, by the spectra of both (Welch), of which the means of the samples are
    taken. Of a recording that crosses the gap it is not that of teeth in contact."""
    drive = identified.drive
    T_mot = drive.T_mot.mean(axis=1) / identified.p.g_T
    omega_1 = 0.5 * (drive.omega_1[1:] + drive.omega_1[:-1])
    rate, length = 1.0 / drive.T_s, min(WINDOW, len(drive))
    f, cross = csd(T_mot, omega_1, rate, nperseg=length, detrend="linear")
    _, power = welch(T_mot, rate, nperseg=length, detrend="linear")
    return f, cross / power
