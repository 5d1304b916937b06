"""Signals within a band of frequencies, over time.

Filters are of Butterworth, of order 4, run forwards and backwards, so that nothing is shifted.
"""

from typing import Any

import numpy as np

from toolground.progress import chunks

from .oscillation import SPAN
from .spectrum import DRIVE_TRAIN, TO_50_HZ

HIGHEST = 0.9
"""Of half the sampling rate: the highest corner of a filter."""

FILTERED = 2**17
"""Samples that are filtered at a time."""


def band_part(x: np.ndarray, T_s: float, band: tuple[float, float] = DRIVE_TRAIN) -> np.ndarray:
    """The part of x (N samples, T_s apart) within a band in Hz that begins at 0 or above; NaN if the samples are too
    far apart to have any of it."""
    from scipy.signal import butter  # takes longer to load than many a run does

    low, high = band[0], min(band[1], HIGHEST / (2.0 * T_s))
    if low >= high:
        return np.full(len(x), np.nan)
    kind, corners = ("bandpass", (low, high)) if low else ("lowpass", high)
    sos = butter(4, corners, kind, fs=1.0 / T_s, output="sos")
    return forwards_and_backwards(sos, x, min(round(SPAN / T_s), len(x) - 1))


def forwards_and_backwards(sos: Any, x: np.ndarray, ends: int) -> np.ndarray:
    """x filtered without shift: the numbers of `scipy.signal.sosfiltfilt` with padlen = ends < len(x), which takes
    four times the memory."""
    from scipy.signal import sosfilt, sosfilt_zi

    y = np.concatenate((2.0 * x[0] - x[ends:0:-1], x, 2.0 * x[-1] - x[-2 : -ends - 2 : -1]))
    for direction in (y, y[::-1]):
        state = sosfilt_zi(sos) * direction[0]
        for piece in chunks(len(y), FILTERED):
            rows = slice(piece.start, piece.stop)
            direction[rows], state = sosfilt(sos, direction[rows], zi=state)
    return y[ends : len(y) - ends]


def envelope(x: np.ndarray, T_s: float, band: tuple[float, float] = DRIVE_TRAIN) -> np.ndarray:
    """The part of x within a band never exceeds it in magnitude: the largest within 0.2 s, averaged over 0.2 s."""
    from scipy.ndimage import maximum_filter1d, uniform_filter1d

    width = 2 * round(0.5 * SPAN / T_s) + 1
    part = band_part(x, T_s, band)
    del x  # of an hour each array counts, and the filters take two more
    np.abs(part, out=part)
    for filtered in (maximum_filter1d, uniform_filter1d):
        filtered(part, width, output=part)
    return part


def derivative(x: np.ndarray, T_s: float, band: tuple[float, float] = TO_50_HZ) -> np.ndarray:
    """dx/dt of the part of x within a band."""
    y = band_part(x, T_s, band)
    slope = np.empty_like(y)
    slope[[0, -1]] = y[1] - y[0], y[-1] - y[-2]
    np.subtract(y[2:], y[:-2], out=slope[1:-1])
    slope[1:-1] /= 2.0
    slope /= T_s
    return slope
