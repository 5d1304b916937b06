"""All that the test of the controller on the target has found."""

from collections.abc import Sequence
from typing import NamedTuple

from ....fmus.target.deviations import Finding, reason
from .comparison import Comparison
from .in_loop import InLoop
from .sample_timing import Schedule
from .size import Size

TYPICAL = "prbs"
"""The manoeuvre in which controllers are compared."""


class Part(NamedTuple):
    """What a controller takes: most instructions in a sample of one manoeuvre, and flash in bytes."""

    controller: str
    instructions: int
    flash: int


class Record(NamedTuple):
    """What the target was found to do: off-line, in the loop, under a timer, and what it takes."""

    comparisons: Sequence[Comparison]
    loops: Sequence[InLoop]
    schedule: Schedule
    size: Size
    findings: Sequence[Finding] = ()
    parts: Sequence[Part] = ()

    @property
    def passed(self) -> bool:
        """Whether no bit differs, the torque of every case that the loop gave is as near to double precision as it
        must, and every deviation from the rules has its reason."""
        near = all(each.margin <= 1.0 or each.case.drawn for each in self.comparisons)
        same = not any(each.differing for each in (*self.comparisons, *self.loops))
        explained = all(reason(each) for each in self.findings)
        kept = self.schedule.missed == 0 and all(each.finite for each in self.comparisons)
        return near and same and explained and kept
