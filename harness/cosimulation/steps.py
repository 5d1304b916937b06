"""The steps of the master, call by call in Python; `harness.cosimulation.compiled` makes the same ones faster."""

from collections.abc import Callable, Sequence
from ctypes import c_double
from math import isfinite
from typing import NamedTuple

import numpy as np
from fmpy.fmi2 import fmi2OK, fmi2Warning

from .calls import Call
from .whereabouts import AT_START, note

NOT_FINITE = -(2**31)
"""The status, which no FMU returns, of a call that put out NaN or infinity."""


class Refusal(NamedTuple):
    """The call that was refused, its status, and the number of the step."""

    call: Call
    status: int
    step: int


def made(call: Call, time: float = AT_START) -> int:
    """The status of a call that is made at a time in s; what it puts out is looked at."""
    note(call.instance.number, call.function, time)
    status = call.run()
    if status in (fmi2OK, fmi2Warning) and call.function == "fmi2GetReal" and not all(map(isfinite, call.values)):
        return NOT_FINITE
    return status


Steps = Callable[[np.ndarray, range], Refusal | None]
"""Makes the steps of these numbers, or those up to a refusal, and fills the rows of a table of all instants."""

MakeSteps = Callable[[Sequence[Call], bytearray, int], Steps]
"""Binds the calls of a step, the row of bytes that they work on, and how many bytes at its beginning are known
in advance: they come from the table, the others go there."""


def interpreted(calls: Sequence[Call], row: bytearray, known: int) -> Steps:
    """The steps, each of which is these calls in this order; an unchanged set of values is not set again."""
    size, now = len(row), memoryview(row)
    computed, time = now[known:], c_double.from_buffer(row)

    def steps(table: np.ndarray, numbers: range) -> Refusal | None:
        data = table.view(np.uint8).data
        for k in numbers:
            start = k * size
            now[:known] = data[start : start + known]
            for call in calls:
                if call.changed and not call.changed():
                    continue
                status = made(call, time.value)
                if status not in (fmi2OK, fmi2Warning):
                    return Refusal(call, status, k)
            data[start + size + known : start + size + size] = computed
        return None

    return steps
