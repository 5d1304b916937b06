"""Samples without a value: codes that loggers write in its place, and holes, the short ones filled."""

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .thresholds import Threshold

NINES = {sign * (10.0**digits - unit) for digits in range(3, 11) for unit in (1.0, 0.1, 0.01) for sign in (1.0, -1.0)}
"""999, 9999.9, ..."""

HUGE = 1e29
"""Magnitude of what cannot be measured: 9.9e34 of DIAdem, the largest numbers of single and double precision."""


def _ends(bits: Iterable[int], reserved: int) -> set[float]:
    """The largest and smallest integers of so many bits, with and without a sign, and some beside them."""
    return {
        end
        for n in bits
        for k in range(reserved)
        for end in (2.0**n - 1.0 - k, 2.0 ** (n - 1) - 1.0 - k, k - 2.0 ** (n - 1))
    }


# J1939 keeps the largest for "not available" and the next for "error"
ENDS, RESERVED = _ends((8, 12, 16, 32), 1), _ends((*range(8, 17), 20, 24, 32, 48, 64), 2)
"""Of the integers that are usual, and of all in which signals are sent, with what else is kept for errors there."""

RESOLUTIONS = (
    *(digit * 10.0**-k for k in range(5) for digit in (1.0, 5.0, 2.0, 2.5, 1.25)),
    *(2.0**-k for k in range(4, 11)),
)
"""Of signals, in the units of their files; that of the column itself is tried beside them."""

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
EXACTLY, WRITTEN = 1e-9, 2e-6
"""Part by which a decimal code may be off, and an integer as it was written, with six digits at least."""

LATE = Threshold(
    1.5, "1", "step of time over samples without a value, in intervals, that makes a hole", "one is missing at 2"
)


# numbers that are nearly 0 among others ended in a traceback
MOST_STEPS = 2.0**53


def is_code(values: ArrayLike) -> Any:
    """Which numbers of a file are codes, whatever their resolution."""
    return (np.abs(values) > HUGE) | _near(values, NINES, EXACTLY) | _near(values, ENDS, WRITTEN)


def is_scaled_code(values: np.ndarray, *own: float) -> Any:
    """Which are a reserved integer times a resolution: one that is usual, or that of the column."""
    integers = np.divide.outer(np.clip(values, -HUGE, HUGE), (*RESOLUTIONS, *own))
    return _near(integers, RESERVED, WRITTEN).any(axis=-1)


def _near(values: ArrayLike, codes: set[float], part: float) -> Any:
    those = np.array([*codes])
    return (np.abs(np.subtract.outer(values, those)) < part * np.abs(those)).any(axis=-1)


def _resolution(values: np.ndarray) -> tuple[float, ...]:
    """That of a column, of its different values in ascending order; nothing of less than two, nor where they have more
    steps between them than a number can count."""
    inner = values[MOST:-MOST] if len(values) > 3 * MOST else values
    with np.errstate(over="ignore"):
        steps = np.ptp(inner) / np.diff(inner).min() if len(inner) > 1 else np.inf
    return (float(np.ptp(inner) / round(steps)),) if steps < MOST_STEPS else ()


def coded(written: np.ndarray) -> np.ndarray:
    """Which of the values of a file (n,) stand for a missing one: beyond all others, and far from them."""
    values = np.sort(written[np.isfinite(written)])
    values = values[np.diff(values, prepend=-np.inf) > 0.0]  # np.unique hashes, which takes ten times as long
    outer = np.unique(np.concatenate((values[:MOST], values[-MOST:])))
    own = _resolution(values[np.abs(values) < HUGE])
    sure, perhaps = is_code(outer), is_scaled_code(outer, *own)
    others = values[~np.isin(values, outer[sure | perhaps])]
    if not len(others):
        return np.zeros(len(written), dtype=bool)
    distance = np.maximum(others[0] - outer, outer - others[-1])
    far = sure & (distance > ALONE * np.ptp(others))
    if len(others) >= MEASURED:
        # 12.6 N.m was a code of 8 bits once, at the range of all others
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
    gaps = np.flatnonzero((steps > LATE * interval) & (np.diff(there) > 1))
    # the last digits of written times must not decide
    short = gaps[steps[gaps] - interval <= longest * (1.0 + 1e-6)]
    between = ((int(there[k]) + 1, int(there[k + 1])) for k in short)
    filled = np.concatenate([none, *(np.arange(first, end) for first, end in between)])
    values = values.copy()
    if held:
        values[filled] = values[there[np.searchsorted(there, filled) - 1]]
    else:
        values[filled] = np.interp(time[filled], time[there], values[there])
    return Holes(values, filled, [(int(there[k]), int(there[k + 1])) for k in np.setdiff1d(gaps, short)])
