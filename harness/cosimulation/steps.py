"""The steps of the master, call by call in Python; `harness.cosimulation.compiled` makes the same ones faster."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from fmpy.fmi2 import fmi2Warning

from .calls import Call


class Refusal(NamedTuple):
    """The call that was refused, its status, and the number of the step."""

    call: Call
    status: int
    step: int


class Memory(NamedTuple):
    """What the calls of a loop work on.

    Attributes:
        row: the instant at work.
        known: number of bytes at its beginning that come from the table; the others go there.
        table: all instants.
    """

    row: bytearray
    known: int
    table: np.ndarray


Steps = Callable[[range], Refusal | None]
"""Makes the steps of that numbers, or those up to a refusal."""


def interpreted(calls: Sequence[Call], memory: Memory) -> Steps:
    """The steps, each of which is these calls in this order."""
    runs = [call.run for call in calls]
    data, row, known = memory.table.view(np.uint8).data, memoryview(memory.row), memory.known
    size, computed = len(row), row[memory.known :]

    def steps(numbers: range) -> Refusal | None:
        for k in numbers:
            start = k * size
            row[:known] = data[start : start + known]
            for run in runs:
                status = run()
                if status > fmi2Warning:
                    return Refusal(calls[runs.index(run)], status, k)
            data[start + size + known : start + size + size] = computed
        return None

    return steps
