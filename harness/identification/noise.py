"""White noise of a recorded channel, from the floor of its spectrum at high frequencies.

Little of what a drive train does is there, but that little comes in two forms. Hits of the gear and steps of the torque
are short and fill all frequencies; the ripple of a motor lasts and keeps to its own. So the power is looked at window
by window and frequency by frequency. That of white noise is exponentially distributed over the windows; windows with a
hit lie above and are left out, and of the frequencies the lower quartile is taken, which a ripple does not move. Short
windows part hits from what is between them, long ones part frequencies: the smaller of both answers counts.
"""

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from scipy.signal.windows import hann

from driverecords.thresholds import Threshold

WINDOWS = (12, 40)
"""Samples of a window."""

FLOOR_WINDOW, ENOUGH = 24, 100
"""Samples of a window for the floor by frequency, in which it shows what interpolation leaves out at some of them, and
samples for four such windows."""

LOWEST, HIGHEST = 0.4, 0.97
"""Frequencies that are looked at, over that of Nyquist: 100 to 242 Hz at 2 ms."""

USUAL = Threshold(
    2.0, "1", "power of a window over the mean, above which it is no noise", "of noise one in seven is above"
)

PASSES = 60


def white_noise(x: np.ndarray, coloured: bool = False) -> float:
    """The standard deviation of the white noise in a signal, with that of its rounding, in its unit.

    The samples must be those of the sensor: noise that has been filtered or interpolated is no longer white. They must
    be faster than the drive train: from 5 ms on, some of what it does counts as noise.

    Args:
        x: at equal intervals, shape (n,), n well above 100.
        coloured: whether it was interpolated, so that little is left at the highest frequencies: that of the lowest
            ones counts then. Of a motor speed half-way between its samples .7 is found so, and .3 else.
    """
    share = 1.0 if coloured else 0.25
    return float(np.sqrt(min(np.quantile(_between_hits(_power(x, n)), share) for n in WINDOWS)))


def noise_floor(x: np.ndarray) -> np.ndarray:
    """Variance that the noise in a signal would have if it were white, as each frequency from LOWEST to HIGHEST tells
    it, shape (7,): much the same if the samples are those of the sensor, but where a ripple is.

    Args:
        x: as of `white_noise`, of ENOUGH samples.
    """
    return _between_hits(_power(x, FLOOR_WINDOW))


def _power(x: np.ndarray, n: int) -> np.ndarray:
    """Of windows of n samples, in units of the variance of white noise; shape (windows, frequencies)."""
    frequencies = np.arange(np.ceil(LOWEST * n / 2), np.floor(HIGHEST * n / 2) + 1)
    waves = hann(n, sym=False) * np.exp(-2j * np.pi / n * np.outer(frequencies, np.arange(n)))
    # of the second differences, which take away the slow and large parts
    filters = np.array([np.convolve(wave, [1.0, -2.0, 1.0]) for wave in waves])
    windows = sliding_window_view(x, n + 2)[:: n // 8]
    return np.abs(windows @ filters.T) ** 2 / np.sum(np.abs(filters) ** 2, axis=1)


def _between_hits(power: np.ndarray) -> np.ndarray:
    """Mean power of each frequency as that of the usual windows tells, if it is exponentially distributed."""
    share = 1.0 - USUAL / np.expm1(USUAL)  # mean of what is below USUAL, over the mean of all
    mean = np.median(power, axis=0) / np.log(2.0)
    for _ in range(PASSES):
        usual = power < USUAL * mean
        mean = np.sum(power, axis=0, where=usual) / np.maximum(usual.sum(axis=0), 1) / share
    return mean
