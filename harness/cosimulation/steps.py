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


Steps = Callable[[np.ndarray, range], Refusal | None]
"""Makes the steps of these numbers, or those up to a refusal, and fills the rows of a table of all instants."""

MakeSteps = Callable[[Sequence[Call], bytearray, int], Steps]
"""Binds the calls of a step, the row of bytes that they work on, and how many bytes at its beginning are known
in advance: they come from the table, the others go there."""


def interpreted(calls: Sequence[Call], row: bytearray, known: int) -> Steps:
    """The steps, each of which is these calls in this order; an unchanged set of values is not set again."""
    pairs = [(call.changed, call.run) for call in calls]
    size, now = len(row), memoryview(row)
    computed = now[known:]

    def steps(table: np.ndarray, numbers: range) -> Refusal | None:
        data = table.view(np.uint8).data
        for k in numbers:
            start = k * size
            now[:known] = data[start : start + known]
            for pair in pairs:
                changed, run = pair
                if changed and not changed():
                    continue
                status = run()
                if status > fmi2Warning:
                    return Refusal(calls[pairs.index(pair)], status, k)
            data[start + size + known : start + size + size] = computed
        return None

    return steps
