"""The FMI calls of the loop, bound to their arguments once.

A row of the run is the only memory: an FMU's outputs are read straight into it, its inputs are
gathered from it. Every call returns its FMI status.
"""

from collections.abc import Callable, Mapping, Sequence
from ctypes import c_double, c_int, c_size_t, c_uint
from functools import partial
from operator import itemgetter
from typing import Any, NamedTuple

from fmpy.model_description import ModelVariable

from .instance import Instance
from .interface import type_of
from .row import KINDS, Layout


class Call(NamedTuple):
    """A bound call, what it is made of, and what an error message says of it.

    Attributes:
        run: makes the call.
        changed: takes over the values to be set and tells whether they differ from those before; None: nothing is set.
        arguments: of the FMI function after the component, as ctypes objects.
        sources: of the values that are set, in bytes from the beginning of the row.
        factors: what the FMU's values are multiplied by to be those of the row; empty: they are the same.
        names: of the variables whose values are set or got.
    """

    instance: Instance
    function: str
    run: Callable[[], int]
    arguments: tuple[Any, ...]
    changed: Callable[[], bool] | None = None
    sources: Sequence[int] = ()
    factors: Sequence[float] = ()
    names: Sequence[str] = ()

    @property
    def values(self) -> Sequence[Any]:
        """Those that are set or got."""
        return self.arguments[-1]


def sends(instance: Instance, sources: Mapping[str, str], row: bytearray, layout: Layout) -> list[Call]:
    """Calls that set the inputs, one for each type.

    Args:
        sources: `instance.variable` of an input -> column of the row that feeds it.
    """
    calls = []
    fed = [v for v in instance.interface.of_causality("input") if f"{instance.name}.{v.name}" in sources]
    for kind, variables in _by_type(fed):
        offsets = [layout.offset(sources[f"{instance.name}.{v.name}"]) for v in variables]
        buffer = (KINDS[kind].ctype * len(variables))()
        call = _access(instance, f"fmi2Set{kind}", variables, buffer)
        changed = _change(memoryview(row).cast(KINDS[kind].code), offsets, buffer, call.factors)
        calls.append(call._replace(changed=changed, sources=offsets))
    return calls


def _change(view: Any, offsets: Sequence[int], buffer: Any, factors: Sequence[float]) -> Callable[[], bool]:
    places = [offset // view.itemsize for offset in offsets]
    pick = itemgetter(*places) if len(places) > 1 else lambda view: (view[places[0]],)

    def changed() -> bool:
        values = pick(view)
        if factors:
            values = tuple(value / factor for value, factor in zip(values, factors, strict=True))
        if values == tuple(buffer):
            return False
        buffer[:] = values
        return True

    return changed


def receives(instance: Instance, row: bytearray, layout: Layout) -> list[Call]:
    """Calls that read the outputs into the row, one for each type."""
    calls = []
    for kind, variables in _by_type(instance.interface.of_causality("output")):
        first = layout.offset(f"{instance.name}.{variables[0].name}")
        place = (KINDS[kind].ctype * len(variables)).from_buffer(row, first)
        call = _access(instance, f"fmi2Get{kind}", variables, place)
        calls.append(call._replace(run=_converting(call.run, place, call.factors)) if call.factors else call)
    return calls


def _converting(get_values: Callable[[], int], place: Any, factors: Sequence[float]) -> Callable[[], int]:
    def get() -> int:
        status = get_values()
        place[:] = [value * factor for value, factor in zip(place, factors, strict=True)]
        return status

    return get


def advance(instance: Instance, row: bytearray, step_size: c_double) -> Call:
    """The call that makes one communication step from the time in the row, of the size in s at that moment."""
    return _bound(instance, "fmi2DoStep", c_double.from_buffer(row), step_size, c_int(1))


def _by_type(variables: Sequence[ModelVariable]) -> list[tuple[str, list[ModelVariable]]]:
    alike = [(kind, [v for v in variables if type_of(v) == kind]) for kind in KINDS]
    return [(kind, group) for kind, group in alike if group]


def _access(instance: Instance, function: str, variables: Sequence[ModelVariable], place: Any) -> Call:
    references = (c_uint * len(variables))(*(v.valueReference for v in variables))
    factors = [instance.interface.factors.get(v.name, 1.0) for v in variables]
    call = _bound(instance, function, references, c_size_t(len(variables)), place)
    call = call._replace(names=[v.name for v in variables])
    return call._replace(factors=factors) if any(factor != 1.0 for factor in factors) else call


def _bound(instance: Instance, function: str, *arguments: Any) -> Call:
    return Call(instance, function, partial(instance.function(function), instance.component, *arguments), arguments)
