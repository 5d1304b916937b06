"""How a block runs: time passes in steps of any length, with the inputs held over each of them.

A continuous block is integrated. A sampled block ticks at k T_s from the start on: a tick is made in the
step that begins at its instant or holds it, with the inputs of that step, and what it computes shows
one T_s later.

Between ticks the time to the next one is kept, in sample times, and not the time since the start: hosts count their
steps or add them up, and the sum of 1e7 steps of 1 ms is 2 us off.
"""

import math
from abc import ABC, abstractmethod
from functools import cache
from typing import Any

from .declaration import Record
from .integrator import Integrator
from .types import Block, ContinuousBlock, SampledBlock

TICK_TOLERANCE = 1e-3
"""In sample times: a tick this close to the end of a step is at it."""


class Runner(ABC):
    """A block at work.

    Attributes:
        x: its state now.
        p: its parameters; those that are tunable may be changed between steps.
    """

    def __init__(self, block: Block, u: object, p: object) -> None:
        """At the start, with the inputs u of that instant and the parameters p."""
        self.p = p
        self.x = block.start(u, p)
        self._output = block.output

    def output(self, u: object) -> Any:
        """The outputs now."""
        return self._output(self.x, u, self.p)

    @abstractmethod
    def advance(self, u: object, duration: float) -> None:
        """Lets `duration` seconds pass with the inputs u; any time above 0."""

    @property
    @abstractmethod
    def memory(self) -> Record:
        """All that the rest of the run depends on, beside the parameters."""

    @abstractmethod
    def restore(self, memory: Record) -> None:
        """Goes back to where `memory` was taken."""


_integrator = cache(Integrator)


class ContinuousRunner(Runner):
    """A continuous block, integrated."""

    def __init__(self, block: ContinuousBlock, u: object, p: object) -> None:
        super().__init__(block, u, p)
        self._integrator = _integrator(block)

    def advance(self, u: object, duration: float) -> None:
        self.x = self._integrator.advance(self.x, u, self.p, duration)

    @property
    def memory(self) -> Record:
        return (self.x,)

    def restore(self, memory: Record) -> None:
        (self.x,) = memory


class SampledRunner(Runner):
    """A sampled block, ticking; what its last tick computed is on its way to become the state."""

    def __init__(self, block: SampledBlock, u: object, p: object) -> None:
        super().__init__(block, u, p)
        self._update, self._sample_time = block.update, block.sample_time
        self._coming = self.x
        self._to_tick = 0.0

    def advance(self, u: object, duration: float) -> None:
        self._to_tick -= duration / self._sample_time
        due = max(math.ceil(-self._to_tick - TICK_TOLERANCE), 0)
        for _ in range(due):
            self.x, self._coming = self._coming, self._update(self._coming, u, self.p)
        self._to_tick += due
        if self._to_tick <= TICK_TOLERANCE:
            self.x = self._coming

    @property
    def memory(self) -> Record:
        return self.x, self._coming, self._to_tick

    def restore(self, memory: Record) -> None:
        self.x, self._coming, self._to_tick = memory


def runner(block: Block, u: object, p: object) -> Runner:
    """A block at its start, with the inputs u of that instant and the parameters p."""
    if isinstance(block, ContinuousBlock):
        return ContinuousRunner(block, u, p)
    return SampledRunner(block, u, p)
