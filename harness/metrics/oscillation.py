"""How far a record swings, and how fast the swinging fades."""

from math import log, pi, sqrt
from typing import Any

import numpy as np
from numpy.polynomial import Polynomial

from ..base.progress import chunks
from .declaration import Absent

SPAN = 0.2
"""Length in s of the piece within which a swing is measured: more than one period of the drive train."""


FILTERED = 2**17
"""Samples that are filtered at a time."""


def amplitude(x: np.ndarray, T_s: float) -> np.ndarray:
    """A(t) = (max - min)/2 of x over [t, t + 0.2 s), for every sample at which that piece is complete.

    Raises:
        Absent: there is none.
    """
    if len(x) < round(SPAN / T_s):
        raise Absent(f"the run is shorter than {SPAN:g} s")
    pieces = np.lib.stride_tricks.sliding_window_view(x, round(SPAN / T_s))
    swing = np.ptp(pieces, axis=1)
    swing /= 2.0
    return swing


def damping_ratio(y: np.ndarray, T_s: float, first: int, overshoot: float) -> float:
    """Damping ratio of y from sample `first` on, by its logarithmic decrement.

    y, relative to its step, is low-passed at 12 Hz without phase shift. Of its extremes above 0.02 the
    first 30 that alternate are taken; s is the mean decrease of ln|extreme| from one to the next, and
    zeta = s/sqrt(pi^2 + s^2). With fewer than three it follows from the overshoot alone, the
    decrement of one half period.
    """
    from scipy.signal import butter  # takes longer to load than many a run does

    low_pass = butter(2, 12.0, fs=1.0 / T_s, output="sos")
    extremes = _alternating_extremes(forwards_and_backwards(low_pass, y, 9)[first:], round(0.03 / T_s))[:30]
    if len(extremes) >= 3:
        s = -Polynomial.fit(np.arange(len(extremes)), np.log(np.abs(extremes)), 1).convert().coef[1]
    else:
        s = -log(max(1e-4, overshoot))
    return min(1.0, float(s / sqrt(pi**2 + s**2)))


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


def _alternating_extremes(y: np.ndarray, least_distance: int) -> list[float]:
    """Extremes of y above 0.02 that alternate in sign and are `least_distance` samples away from each other.

    Of those that do not alternate or are closer, the largest is kept.
    """
    slope = np.diff(y)
    turning = np.flatnonzero((slope[:-1] * slope[1:] <= 0.0) & (slope[:-1] != 0.0)) + 1
    kept: list[int] = []
    for k in turning[np.abs(y[turning]) > 0.02]:
        if not kept or (y[k] * y[kept[-1]] < 0.0 and k - kept[-1] >= least_distance):
            kept.append(int(k))
        elif abs(y[k]) > abs(y[kept[-1]]):
            kept[-1] = int(k)
    return [float(y[k]) for k in kept]
