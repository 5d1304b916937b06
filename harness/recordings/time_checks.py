"""The times of samples, as a recording has to have them."""

from collections.abc import Callable
from math import isfinite
from pathlib import Path

import numpy as np

from .source import RecordingError


def check_time(path: Path, time: np.ndarray, where: Callable[[int], str], gap: float, jumps: bool = False) -> None:
    """
    Args:
        path: of the recording, for messages.
        time: in s.
        where: of a sample in the file.
        gap: longest step that is still no gap, in median steps.
        jumps: whether two samples may have one time.

    Raises:
        RecordingError: it does not increase, or has a gap.
    """
    steps = np.diff(time)
    backward = np.flatnonzero((steps < 0.0) | ((steps == 0.0) & (not jumps)))
    if len(backward):
        k = int(backward[0])
        raise RecordingError(f"{path}, {where(k + 1)}: time {time[k + 1]:g} s does not come after {time[k]:g} s")
    median = float(np.median(steps))
    gaps = np.flatnonzero(steps > gap * median) if isfinite(gap) else []
    if len(gaps):
        k = int(gaps[0])
        raise RecordingError(
            f"{path}, {where(k + 1)}: gap of {steps[k]:g} s after {time[k]:g} s; at most {gap * median:g} s "
            f"({gap:g} times the median step) is allowed, so cut the file there"
        )
