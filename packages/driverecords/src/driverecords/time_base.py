"""The times of a channel: equal ones at the resolution of a clock, gaps, and the longest piece without any."""

from collections.abc import Callable, Iterable
from math import inf, isfinite
from pathlib import Path
from typing import NamedTuple

import numpy as np

from .clock_times import Clock
from .source import RecordingError
from .thresholds import Threshold

# times 1e300 ended in a ZeroDivisionError of scipy, times 1e-320 in an OverflowError of the balance of forces
INTERVALS = (1e-6, 1e6)
"""In s, of a recording: times in another unit than they are called are within, and filters of signals can be made."""

OFTEN = Threshold(
    0.05,
    "1",
    "share of equal times from which on the clock is coarse",
    "of a row written twice now and then two times are equal, of a coarse clock most",
)


def time_text(time: float) -> str:
    """A time in s without the last digits, as it is typed."""
    return f"{round(time, 9):.15g}"


def interval_of(time: np.ndarray) -> float:
    """Median step of times."""
    return float(np.median(np.diff(time)))


class Cut(NamedTuple):
    """The part of a recording that is read: from and to when, in s or by a clock; None: its begin or end."""

    begin: float | Clock | None = None
    end: float | Clock | None = None

    def within(self, time: np.ndarray, begin: Clock | None) -> np.ndarray:
        """Which times in s are in it.

        Args:
            begin: what the clock says at 0.

        Raises:
            ValueError: there is no clock, and the cut is by one; nothing is in it.
        """
        if self == WHOLE:
            return np.isfinite(time)
        first, last = (self._second(limit, time, begin) for limit in self)
        inside = np.isfinite(time)
        # the last digits of written times must not decide
        if first is not None:
            inside &= time >= first - 1e-12 * abs(first) - 1e-9
        if last is not None:
            inside &= time <= last + 1e-12 * abs(last) + 1e-9
        if not inside.any():
            options = " ".join(
                f"--{name} {limit}" for name, limit in zip(("from", "to"), self, strict=True) if limit is not None
            )
            clock = f" ({begin} at 0)" if begin else ""
            raise ValueError(
                f"no sample is within {options}; it goes from {time_text(float(np.nanmin(time)))} to "
                f"{time_text(float(np.nanmax(time)))} s{clock}"
            )
        return inside

    @staticmethod
    def _second(limit: float | Clock | None, time: np.ndarray, begin: Clock | None) -> float | None:
        if not isinstance(limit, Clock):
            return limit
        if begin is None:
            raise ValueError("it has no times of day; --from and --to must be seconds")
        return limit.after(begin, float(np.nanmax(time)))


WHOLE = Cut()

MOST = 100
"""Samples that cannot be used up to which the longest piece without any is looked for."""


class Break(NamedTuple):
    """Where a recording cannot be used.

    Attributes:
        end: time in s up to which what is before can be, -inf if nothing can.
        begin: time from which on what is after can be, inf if nothing can.
        problem: in words.
        advice: options that mend it, with the mark before it.
    """

    end: float
    begin: float
    problem: str
    advice: str = ""


def break_around(time: np.ndarray, first: int, last: int, problem: str) -> Break:
    """A break at the samples between two indices, these included."""
    low, high = time[first : last + 1].min(), time[first : last + 1].max()
    before, after = time[time < low], time[time > high]
    return Break(before.max(initial=-inf), after.min(initial=inf), problem)


def clean_pieces(begin: float, end: float, breaks: Iterable[Break]) -> list[tuple[float, float]]:
    """The times in s without a break, from when to when."""
    pieces, at = [], begin
    for break_ in sorted(breaks):
        pieces.append((at, min(break_.end, end)))
        at = max(at, break_.begin)
    return [piece for piece in [*pieces, (at, end)] if piece[1] > piece[0]]


def spread_equal_times(time: np.ndarray) -> np.ndarray:
    """Times (n,) in s of which those that are equal, because the clock is coarse, are spread up to the next one.

    Where all times are those of a steady clock within that resolution, they are its times. Single equal ones are left.
    """
    steps = np.diff(time)
    if not len(steps) or not (steps == 0.0).any() or not (steps > 0.0).any() or np.mean(steps == 0.0) < OFTEN:
        return time
    k = np.arange(len(time))
    first = np.flatnonzero(np.append(True, steps != 0.0))
    if (steps >= 0.0).all() and len(first) > 4:
        inner = first[1:-1]  # the first and the last may be cut short
        steady = time[0] + np.polyfit(inner, time[inner] - time[0], 1)[0] * k
        if np.ptp(steady - time) <= 1.05 * steps[steps > 0.0].min():
            return steady
    length = np.diff(np.append(first, len(time)))
    until = np.append(time[first[1:]], time[first[-1]] + np.median(steps[steps > 0.0]))
    run = np.repeat(np.arange(len(first)), length)
    return time + (k - first[run]) * np.maximum(until - time[first], 0.0)[run] / length[run]


def time_breaks(
    path: Path, time: np.ndarray, where: Callable[[int], str], gap: float, jumps: bool = False
) -> list[Break]:
    """Where time does not increase, or has a gap.

    Args:
        path: of the recording, for messages.
        time: in s.
        where: of a sample in the file.
        gap: longest step that is still no gap, in median steps.
        jumps: whether two samples may have one time.

    Raises:
        RecordingError: the steps are such as no recording has.
    """
    steps = np.diff(time)
    backward = np.flatnonzero((steps < 0.0) | ((steps == 0.0) & (not jumps)))
    breaks = []
    for k in backward[:MOST].tolist():
        before, after = time_text(float(time[k])), time_text(float(time[k + 1]))
        problem = f"{path}, {where(k + 1)}: time {after} s does not come after {before} s"
        breaks.append(break_around(time, k, k + 1, problem) if len(backward) <= MOST else Break(-inf, inf, problem))
    if jumps:
        return breaks
    median = float(np.median(steps))
    least, most = INTERVALS
    if not breaks and not least <= median <= most:
        raise RecordingError(
            f"{path}, {where(1)}: the sample interval is {median:g} s; {least:g} to {most:g} s are allowed"
        )
    gaps = np.flatnonzero(steps > gap * median) if isfinite(gap) and median > 0.0 else np.empty(0, dtype=int)
    return breaks + [
        Break(
            float(time[k]),
            float(time[k + 1]),
            f"{path}, {where(k + 1)}: gap of {steps[k]:g} s after {time_text(float(time[k]))} s; at most "
            f"{gap * median:g} s ({gap:g} times the median step) is allowed",
        )
        for k in gaps.tolist()
    ]
