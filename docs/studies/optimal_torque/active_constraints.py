"""Active constraints: those on overshoot and swings hold at all samples, and matter at a few of them."""

from dataclasses import dataclass, field

import numpy as np
from numpy.polynomial import Polynomial

from driveline.harness.loop.places import T_S
from driveline.harness.metrics.oscillation import SPAN
from driveline.harness.metrics.step_response import SETTLED, fitted

from .task import Task

DENSE, SPARSE = 150, 25
"""To begin with, so many samples from 90 % of the way on are active, and later every SPARSEth."""

SWING_RESERVE = 0.02
"""Torque in N.m by which less is allowed to swing: more than solver and linear car are off by."""

TOLERATED = 5e-3
"""Swing and overshoot in N.m that activates no constraint."""


@dataclass
class ActiveConstraints:
    """The working set: samples at which constraints are kept that hold at all samples, where they were violated.

    Leaving out the others makes no bound too high.

    Attributes:
        peaks: of the overshoot, which rise.
        swings: pairs, from the lower to the higher, of what has to be settled.
    """

    peaks: list[int]
    swings: list[tuple[int, int]] = field(default_factory=list)

    @classmethod
    def of(cls, task: Task) -> "ActiveConstraints":
        """To begin with."""
        begin, end = task.sample(task.reached.response_delay), len(task.times)
        return cls(sorted({*range(begin, min(begin + DENSE, end)), *range(begin, end, SPARSE)}))

    def violated(self, task: Task, T_gear: np.ndarray) -> bool:
        """Adds where a gear torque (samples,) in N.m overshoots and swings most; whether there was more to add."""
        peaks, swings = self._peaks(task, T_gear), _unsettled(task, T_gear)
        self.peaks = sorted({*self.peaks, *peaks})
        self.swings += swings
        return bool(peaks or swings)

    def _peaks(self, task: Task, T_gear: np.ndarray) -> list[int]:
        last = fitted(task.times)
        line = Polynomial.fit(task.times[last], T_gear[last], 1)
        over = task.sign * (T_gear - line(task.times))
        highest = over[self.peaks].max() + TOLERATED
        inner = np.flatnonzero((over[1:-1] >= over[:-2]) & (over[1:-1] >= over[2:]) & (over[1:-1] > highest)) + 1
        return [int(k) for k in inner]


def settled_swing(task: Task) -> float:
    """Peak to peak in N.m that counts as settled."""
    return 2.0 * SETTLED * abs(task.dT)


def _unsettled(task: Task, T_gear: np.ndarray) -> list[tuple[int, int]]:
    """The largest swings that settle later than the controller; of pieces near each other the largest."""
    begin, length = task.sample(task.reached.settling_time), round(SPAN / T_S)
    pieces = np.lib.stride_tricks.sliding_window_view(T_gear[begin:], length)
    excess = np.ptp(pieces, axis=1) - settled_swing(task) + SWING_RESERVE
    swings: list[tuple[int, int]] = []
    while excess.max() > TOLERATED:
        worst = int(excess.argmax())
        low, high = (begin + worst + int(k) for k in (pieces[worst].argmin(), pieces[worst].argmax()))
        swings.append((low, high))
        excess[max(worst - length // 4, 0) : worst + length // 4] = 0.0
    return swings
