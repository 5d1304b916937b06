"""The FMI calls of the loop, bound to their arguments once: each is a function without arguments.

A row of the run is the only memory: an FMU's outputs are read straight into it, its inputs are
gathered from it. Every call returns its FMI status.
"""

from collections.abc import Callable, Mapping, Sequence
from ctypes import byref, c_double, c_int, c_size_t, c_uint
from functools import partial
from operator import itemgetter
from typing import Any, NamedTuple

from fmpy.fmi2 import fmi2OK

from .instance import Instance
from .interface import type_of
from .layout import KINDS, Layout


class Call(NamedTuple):
    """A bound call, and what an error message says of it."""

    instance: Instance
    function: str
    run: Callable[[], int]


def sends(instance: Instance, sources: Mapping[str, str], row: bytearray, layout: Layout) -> list[Call]:
    """Calls that set the inputs, one for each type; an unchanged set of values is not sent again.

    Args:
        sources: input of the instance -> column of the row that feeds it.
    """
    calls = []
    for kind, (ctype, code, _) in KINDS.items():
        fed = [v for v in instance.interface.of_causality("input") if v.name in sources and type_of(v) == kind]
        if fed:
            view: Any = memoryview(row).cast(code)
            places = [layout.offset(sources[v.name]) // view.itemsize for v in fed]
            buffer = (ctype * len(fed))()
            function = f"fmi2Set{kind}"
            set_values = _bound(instance, function, [v.valueReference for v in fed], byref(buffer))
            calls.append(Call(instance, function, _sender(set_values, view, places, buffer)))
    return calls


def _sender(set_values: Callable[[], int], view: Any, places: Sequence[int], buffer: Any) -> Callable[[], int]:
    pick = itemgetter(*places) if len(places) > 1 else lambda view: (view[places[0]],)
    sent = None

    def send() -> int:
        nonlocal sent
        values = pick(view)
        if values == sent:
            return fmi2OK
        sent = values
        buffer[:] = values
        return set_values()

    return send


def receives(instance: Instance, row: bytearray, layout: Layout) -> list[Call]:
    """Calls that read the outputs into the row, one for each type."""
    calls = []
    for kind, (ctype, _, _) in KINDS.items():
        outputs = [v for v in instance.interface.of_causality("output") if type_of(v) == kind]
        if outputs:
            first = layout.offset(f"{instance.name}.{outputs[0].name}")
            place = (ctype * len(outputs)).from_buffer(row, first)
            function = f"fmi2Get{kind}"
            run = _bound(instance, function, [v.valueReference for v in outputs], byref(place))
            calls.append(Call(instance, function, run))
    return calls


def _bound(instance: Instance, function: str, references: Sequence[int], values: Any) -> Callable[[], int]:
    count = len(references)
    return partial(
        instance.function(function),
        instance.component,
        byref((c_uint * count)(*references)),
        c_size_t(count),
        values,
    )


def advance(instance: Instance, row: bytearray, step_size: float) -> Call:
    """The call that makes one communication step from the time in the row."""
    time = c_double.from_buffer(row)
    run = partial(instance.function("fmi2DoStep"), instance.component, time, c_double(step_size), c_int(1))
    return Call(instance, "fmi2DoStep", run)
