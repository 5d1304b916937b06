"""Filters without a delay, for what is estimated of a recording; no recording is filtered itself."""

import numpy as np
from scipy.signal import butter, sosfiltfilt

ORDER = 4


def low(x: np.ndarray, interval: float, frequency: float) -> np.ndarray:
    """What of a signal, `interval` s apart, is slower than a frequency in Hz (Butterworth, forwards and backwards)."""
    return sosfiltfilt(butter(ORDER, _below_nyquist(frequency, interval), fs=1.0 / interval, output="sos"), x)


def band(x: np.ndarray, interval: float, frequencies: tuple[float, float]) -> np.ndarray:
    """What of it lies between two frequencies in Hz."""
    between = [_below_nyquist(frequency, interval) for frequency in frequencies]
    return sosfiltfilt(butter(ORDER, between, btype="band", fs=1.0 / interval, output="sos"), x)


def _below_nyquist(frequency: float, interval: float) -> float:
    return min(frequency, 0.45 / interval)
