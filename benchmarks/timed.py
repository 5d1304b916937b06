"""What the steps of a run take, without loading and initialization."""

from collections.abc import Callable, Sequence
from time import process_time

import numpy as np

from fmuloop.calls import Call
from fmuloop.steps import MakeSteps, Refusal, Steps


class Timed:
    """Stands in for a MakeSteps and adds up the seconds that its steps take."""

    def __init__(self, make: MakeSteps, clock: Callable[[], float] = process_time) -> None:
        self.make, self.clock, self.seconds = make, clock, 0.0

    def __call__(self, begin: Sequence[Call], end: Sequence[Call], row: bytearray, known: int) -> Steps:
        make_them = self.make(begin, end, row, known)

        def steps(table: np.ndarray, numbers: range) -> Refusal | None:
            began = self.clock()
            refusal = make_them(table, numbers)
            self.seconds += self.clock() - began
            return refusal

        return steps
