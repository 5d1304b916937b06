"""The FMI calls of the loop, bound to their arguments once.

A row of the run is the only memory: an FMU's outputs are read straight into it, its inputs are
gathered from it. Every call returns its FMI status.
"""

from collections.abc import Callable, Mapping, Sequence
from ctypes import c_double, c_int, c_size_t, c_uint
from functools import partial
from operator import itemgetter
from typing import Any, NamedTuple

from fmpy.fmi2 import fmi2OK

from .instance import Instance
from .row import KINDS, Layout
from .wiring import type_of


class Call(NamedTuple):
    """A bound call, what it is made of, and what an error message says of it.

    Attributes:
        run: makes the call.
        arguments: of the FMI function after the component, as ctypes objects.
        sources: of the values that are set, in bytes from the beginning of the row.
    """

    instance: Instance
    function: str
    run: Callable[[], int]
    arguments: tuple[Any, ...]
    sources: Sequence[int] = ()


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
            offsets = [layout.offset(sources[v.name]) for v in fed]
            buffer = (ctype * len(fed))()
            call = _bound(instance, f"fmi2Set{kind}", *_values([v.valueReference for v in fed], buffer))
            send = _sender(call.run, view, [offset // view.itemsize for offset in offsets], buffer)
            calls.append(call._replace(run=send, sources=offsets))
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
            calls.append(_bound(instance, f"fmi2Get{kind}", *_values([v.valueReference for v in outputs], place)))
    return calls


def _values(references: Sequence[int], place: Any) -> tuple[Any, ...]:
    return (c_uint * len(references))(*references), c_size_t(len(references)), place


def advance(instance: Instance, row: bytearray, step_size: float) -> Call:
    """The call that makes one communication step from the time in the row."""
    return _bound(instance, "fmi2DoStep", c_double.from_buffer(row), c_double(step_size), c_int(1))


def _bound(instance: Instance, function: str, *arguments: Any) -> Call:
    return Call(instance, function, partial(instance.function(function), instance.component, *arguments), arguments)
