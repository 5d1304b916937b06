"""The steps of the master, call by call in Python; `fmuloop.compiled_steps` makes the same ones faster."""

from collections.abc import Callable, Sequence
from ctypes import c_double
from math import isfinite
from typing import NamedTuple

import numpy as np
from fmpy.fmi2 import fmi2OK, fmi2Warning

from .call_trace import AT_START, note
from .calls import Call

NOT_FINITE = -(2**31)
"""The status, which no FMU returns, of a call that put out NaN or infinity."""


class Refusal(NamedTuple):
    """The call that was refused, its status, and the numbers of the step and of the instant at work."""

    call: Call
    status: int
    step: int
    instant: int


def status_of(call: Call, time: float = AT_START) -> int:
    """The status of a call that is made at a time in s; what it puts out is looked at."""
    note(call.instance.number, call.function, time)
    status = call.run()
    if call.is_number and status in (fmi2OK, fmi2Warning) and not all(map(isfinite, call.values)):
        return NOT_FINITE
    return status


Steps = Callable[[np.ndarray, range], Refusal | None]
"""Makes the steps of these numbers, or those up to a refusal, and fills the rows of a table of all instants."""

MakeSteps = Callable[[Sequence[Call], Sequence[Call], bytearray, int], Steps]
"""Binds the calls of a step, which are made before and after time goes on to the next instant, to the row of bytes
that they work on. What is known in advance, so many bytes at its beginning, then comes from the table; at the end of
the step the others go there."""


def interpreted(begin: Sequence[Call], end: Sequence[Call], row: bytearray, known: int) -> Steps:
    """The steps, each of which is these calls in this order, if they are due; an unchanged set of values is not set
    again."""
    now, time = memoryview(row), c_double.from_buffer(row)

    def refused(calls: Sequence[Call], k: int) -> tuple[Call, int] | None:
        for call in calls:
            if (k + call.lead) % call.every:
                continue
            if call.changed and not call.changed():
                continue
            status = status_of(call, time.value)
            if status not in (fmi2OK, fmi2Warning):
                return call, status
        return None

    def steps(table: np.ndarray, numbers: range) -> Refusal | None:
        data, size = table.view(np.uint8).data, table.itemsize
        computed = now[known:size]
        for k in numbers:
            if refusal := refused(begin, k):
                return Refusal(*refusal, k, k)
            following = (k + 1) * size
            now[:known] = data[following : following + known]
            if refusal := refused(end, k):
                return Refusal(*refusal, k, k + 1)
            data[following + known : following + size] = computed
        return None

    return steps
