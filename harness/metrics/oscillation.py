"""How far a record swings, and how fast the swinging fades."""

from functools import lru_cache
from math import ceil, log, pi, sqrt, tan

import numpy as np

from .declaration import Absent

SPAN = 0.2
"""Length in s of the piece within which a swing is measured: more than one period of the drive train."""

CONTINUED = 9
"""Samples by which a record is continued before a filter, turned about its ends."""

SHORT = 2**16
"""Samples of a record whose filter is kept for the next one, which often is as long."""

SETTLED = 0.05
"""Share of the step of the demand by which a gear torque that has settled swings; such swings need not fade."""

FADED = 10.0
"""Periods of its corner after which the answer of a low-pass to an impulse is below 1e-19 of its largest value."""


def amplitude(x: np.ndarray, T_s: float) -> np.ndarray:
    """A(t) = (max - min)/2 of x over [t, t + 0.2 s), for every sample at which that piece is complete.

    Raises:
        Absent: there is none.
    """
    length = round(SPAN / T_s)
    if len(x) < length:
        raise Absent(f"the run is shorter than {SPAN:g} s")
    swing = _running(np.maximum, x, length)
    swing -= _running(np.minimum, x, length)
    swing /= 2.0
    return swing


def _running(extreme: np.ufunc, x: np.ndarray, length: int) -> np.ndarray:
    """The largest or smallest of so many neighbours: of twice as many again and again, then of two that overlap."""
    width = 1
    while 2 * width <= length:
        x, width = extreme(x[:-width], x[width:]), 2 * width
    rest = length - width
    return extreme(x[: len(x) - rest], x[rest:])


def damping_ratio(y: np.ndarray, T_s: float, first: int, overshoot: float) -> float:
    """Damping ratio of y from sample `first` on, by its logarithmic decrement.

    y, relative to its step, is low-passed at 12 Hz without phase shift. Of its extremes above 0.02 the
    first 30 that alternate are taken; s is the mean decrease of ln|extreme| from one to the next, and
    zeta = s/sqrt(pi^2 + s^2). With fewer than three, or where none is beyond SETTLED, it follows from the
    overshoot alone, the decrement of one half period.
    """
    extremes = _alternating_extremes(low_passed(y, T_s, 12.0)[first:], round(0.03 / T_s))[:30]
    if len(extremes) >= 3 and max(map(abs, extremes)) > SETTLED:
        numbers = np.arange(2)
        first, second = straight_line(np.arange(len(extremes)), np.log(np.abs(extremes)), numbers)
        s = first - second
    else:
        s = -log(max(1e-4, overshoot))
    return min(1.0, float(s / sqrt(pi**2 + s**2)))


def straight_line(t: np.ndarray, x: np.ndarray, at: np.ndarray) -> np.ndarray:
    """The line of least squares through x over t, at other instants."""
    middle = t.mean()
    since = t - middle
    return x.mean() + np.dot(since, x) / np.dot(since, since) * (at - middle)


def low_passed(x: np.ndarray, T_s: float, corner: float) -> np.ndarray:
    """What of x (N samples, T_s apart) is slower than the corner in Hz: Butterworth of order 2, forwards and backwards.

    It is `scipy.signal.sosfiltfilt`, to rounding; that takes longer to import than many a run takes. The filter is
    applied as its frequency response, to a record with zeros behind it for as long as an impulse is answered.
    """
    if len(x) <= CONTINUED or corner * T_s >= 0.5:
        raise Absent(f"{len(x)} samples every {T_s:g} s are too few for a low-pass at {corner:g} Hz")
    length = 1 << (len(x) + 2 * CONTINUED + ceil(FADED / (corner * T_s))).bit_length()
    response = (_kept_response if length <= SHORT else _response)(length, tan(pi * corner * T_s))
    before, after = 2.0 * x[0] - x[CONTINUED:0:-1], 2.0 * x[-1] - x[-2 : -CONTINUED - 2 : -1]
    passed = np.concatenate((before, x, after))
    for _ in ("forwards", "backwards"):
        constant = passed[0]  # since ever
        moving = np.fft.irfft(response * np.fft.rfft(passed - constant, length), length)[: len(passed)]
        passed = (constant + moving)[::-1]
    return passed[CONTINUED:-CONTINUED]


def _response(length: int, w: float) -> np.ndarray:
    """Of the low-pass with the warped corner w, for so many samples."""
    z = np.exp(-2j * pi * np.fft.rfftfreq(length))  # z^-1
    return (
        w**2
        * (1.0 + z) ** 2
        / (1.0 + sqrt(2.0) * w + w**2 + 2.0 * (w**2 - 1.0) * z + (1.0 - sqrt(2.0) * w + w**2) * z**2)
    )


_kept_response = lru_cache(1)(_response)


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
