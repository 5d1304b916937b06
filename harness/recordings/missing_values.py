"""Samples without a value: codes that loggers write in its place, and holes, the short ones filled."""

from typing import NamedTuple

import numpy as np

from .thresholds import Threshold

NINES = {sign * (10.0**digits - unit) for digits in (3, 4, 5, 6) for unit in (1.0, 0.1, 0.01) for sign in (1.0, -1.0)}
"""999, 9999.9, ..."""

BITS = (8, 12, 16, 32)
"""Of the integers in which signals are sent."""

ENDS = {end for bits in BITS for end in (2.0**bits - 1.0, 2.0 ** (bits - 1) - 1.0, -(2.0 ** (bits - 1)))}
"""Of integers of so many bits."""

RESERVED = ENDS | {
    error for bits in BITS for error in (2.0**bits - 2.0, 2.0 ** (bits - 1) - 2.0, 1.0 - 2.0 ** (bits - 1))
}
"""With what else is kept for errors there."""

RESOLUTIONS = tuple(digit * 10.0**-k for k in range(5) for digit in (1.0, 5.0, 2.0, 2.5, 1.25))
"""Of signals, in the units of their files."""

ALONE, SCALED = (
    Threshold(value, "1", f"distance of a code from all other values, over their range{which}", source)
    for value, which, source in (
        (0.5, "", "a signal comes to its largest value by way of others"),
        (2.0, ", of one that is a multiple of a resolution", "1.1 in 200 simulated drives, of 12.6 and 12.7 N.m"),
    )
)
MEASURED = 10
"""Different values that a channel has at least that was measured; others are switched."""

MOST = 8
"""Codes that a channel has above and below all values."""

FILLED = Threshold(0.1, "s", "longest hole that is filled by a straight line", "a tenth of a period of 1 Hz")
LATE = 1.5
"""Times the interval from which on a step of time over samples without a value is a hole."""


def is_code(value: float) -> bool:
    """Whether a number of a file is one of them, whatever its resolution."""
    return any(_is_one_of(value, NINES | ENDS))


def _is_one_of(value: float, codes: set[float]) -> list[bool]:
    return [abs(value - code) < 1e-9 * abs(code) for code in codes]


def is_scaled_code(value: float) -> bool:
    """Whether it is a reserved integer times a resolution."""
    return any(any(_is_one_of(value / resolution, RESERVED)) for resolution in RESOLUTIONS)


def coded(written: np.ndarray) -> np.ndarray:
    """Which of the values of a file (n,) stand for a missing one: beyond all others, and far from them."""
    values = np.sort(written[np.isfinite(written)])
    values = values[np.diff(values, prepend=-np.inf) > 0.0]  # np.unique hashes, which takes ten times as long
    outer = np.unique(np.concatenate((values[:MOST], values[-MOST:])))
    sure = np.array([is_code(value) for value in outer], dtype=bool)
    perhaps = np.array([is_scaled_code(value) for value in outer], dtype=bool)
    others = values[~np.isin(values, outer[sure | perhaps])]
    if not len(others):
        return np.zeros(len(written), dtype=bool)
    distance = np.maximum(others[0] - outer, outer - others[-1])
    far = sure & (distance > ALONE * np.ptp(others))
    if len(others) >= MEASURED:
        far |= perhaps & (distance > SCALED * np.ptp(others))
    return np.isin(written, outer[far & (distance > 0.0)])


class Holes(NamedTuple):
    """Where a channel has no value for a while between two that it has.

    Attributes:
        values: with the short ones filled.
        filled: indices of the samples that were.
        long: indices of the samples before and after the others.
    """

    values: np.ndarray
    filled: np.ndarray
    long: list[tuple[int, int]]


def holes(time: np.ndarray, values: np.ndarray, longest: float, held: bool) -> Holes:
    """Finds and fills them.

    Args:
        time: in s, not decreasing.
        values: NaN where there is none.
        longest: that is filled, in s.
        held: whether by the last value, and not by a straight line.
    """
    there = np.flatnonzero(np.isfinite(values))
    steps = np.diff(time[there])
    none = np.empty(0, dtype=int)
    if not len(steps) or len(there) == len(values):
        return Holes(values, none, [])
    interval = float(np.median(steps))
    found = np.flatnonzero((steps > LATE * interval) & (np.diff(there) > 1))
    short = found[steps[found] - interval <= longest * (1.0 + 1e-6)]
    between = ((int(there[k]) + 1, int(there[k + 1])) for k in short)
    filled = np.concatenate([none, *(np.arange(first, end) for first, end in between)])
    values = values.copy()
    if held:
        values[filled] = values[there[np.searchsorted(there, filled) - 1]]
    else:
        values[filled] = np.interp(time[filled], time[there], values[there])
    return Holes(values, filled, [(int(there[k]), int(there[k + 1])) for k in np.setdiff1d(found, short)])
