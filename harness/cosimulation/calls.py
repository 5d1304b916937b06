"""The FMI calls of the loop, bound to their arguments once.

A row of the run is the only memory: an FMU's outputs are read straight into it, its inputs are
gathered from it. Every call returns its FMI status.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from ctypes import c_double, c_int, c_size_t, c_uint, sizeof
from functools import partial
from itertools import pairwise
from math import nan
from operator import itemgetter
from typing import Any, NamedTuple

from fmpy.model_description import ModelVariable

from .input_lines import Line, slope, start
from .instance import Instance
from .interface import type_of
from .row_layout import KINDS, Layout


class Call(NamedTuple):
    """A bound call, what it is made of, and what an error message says of it.

    Attributes:
        run: makes the call.
        changed: takes over the values to be set and tells whether they differ from those before; None: nothing is set.
        arguments: of the FMI function after the component, as ctypes objects.
        sources: of the values that are set, in bytes from the beginning of the row.
        factors: what the FMU's values are multiplied by to be those of the row; empty: they are the same.
        names: of the variables whose values are set or got.
        lines: along which inputs are set to move; once they do, what was sent before is forgotten.
        step_size: in s, of calls that depend on it.
    """

    instance: Instance
    function: str
    run: Callable[[], int]
    arguments: tuple[Any, ...]
    changed: Callable[[], bool] | None = None
    sources: Sequence[int] = ()
    factors: Sequence[float] = ()
    names: Sequence[str] = ()
    lines: Sequence[Line] = ()
    step_size: c_double | None = None

    @property
    def values(self) -> Sequence[Any]:
        """Those that are set or got."""
        return self.arguments[-1]


def sends(instance: Instance, sources: Mapping[str, str], row: bytearray, layout: Layout) -> list[Call]:
    """Calls that set the inputs, one for each type.

    Args:
        sources: `instance.variable` of an input -> column of the row that feeds it.
    """
    calls: list[Call] = []
    fed = [v for v in instance.interface.of_causality("input") if f"{instance.name}.{v.name}" in sources]
    for kind, variables in _by_type(fed):
        offsets = [layout.offset(sources[f"{instance.name}.{v.name}"]) for v in variables]
        buffer = (KINDS[kind].ctype * len(variables))()
        call = _access(instance, f"fmi2Set{kind}", variables, buffer)
        changed = _change(memoryview(row).cast(KINDS[kind].code), offsets, buffer, call.factors)
        calls.append(call._replace(changed=changed, sources=offsets))
    return calls


def _change(
    view: "memoryview[Any]", offsets: Sequence[int], buffer: Any, factors: Sequence[float]
) -> Callable[[], bool]:
    places = [offset // view.itemsize for offset in offsets]
    pick: Callable[[memoryview[Any]], tuple[float, ...]]
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


def receives(instance: Instance, row: bytearray, layout: Layout, outputs: Collection[str]) -> list[Call]:
    """Calls that read outputs into the row, one for each piece of it."""
    calls: list[Call] = []
    for kind, variables in _by_type([v for v in instance.interface.of_causality("output") if v.name in outputs]):
        size = sizeof(KINDS[kind].ctype)
        offsets = [layout.offset(f"{instance.name}.{v.name}") for v in variables]
        starts = [n for n, offset in enumerate(offsets) if n == 0 or offset != offsets[n - 1] + size]
        for first, end in pairwise([*starts, len(variables)]):
            place = (KINDS[kind].ctype * (end - first)).from_buffer(row, offsets[first])
            calls.append(_converted(_access(instance, f"fmi2Get{kind}", variables[first:end], place)))
    return calls


def receives_rates(instance: Instance, row: bytearray, outputs: Sequence[str], place: int) -> Call:
    """The call that reads output derivatives into the memory behind the row, from that byte on."""
    variables = [instance.interface.variables[name] for name in outputs]
    values = (c_double * len(variables)).from_buffer(row, place)
    return _converted(_access(instance, "fmi2GetRealOutputDerivatives", variables, values, _first_order(variables)))


def moves(instance: Instance, inputs: Sequence[str], lines: Sequence[Line], step_size: c_double) -> list[Call]:
    """Calls that let inputs move along lines during the step, of the size in s at that moment."""
    variables = [instance.interface.variables[name] for name in inputs]
    rates, starts = (c_double * len(variables))(), (c_double * len(variables))()
    move = _access(instance, "fmi2SetRealInputDerivatives", variables, rates, _first_order(variables))
    begin = _access(instance, "fmi2SetReal", variables, starts)

    def run_begin() -> int:
        starts[:] = [start(line, step_size.value) for line in lines]
        return begin.run()

    def run_move() -> int:
        rates[:] = [slope(line, step_size.value) for line in lines]
        for line in lines:
            line.sent.value = nan
        return move.run()

    kept = {"lines": lines, "step_size": step_size, "factors": ()}
    calls = [begin._replace(run=run_begin, **kept), move._replace(run=run_move, **kept)]
    return calls if any(line.after is not None for line in lines) else calls[1:]


def sent(call: Call, name: str) -> c_double:
    """Where a call that sets inputs keeps what it has set last."""
    return c_double.from_buffer(call.arguments[-1], sizeof(c_double) * list(call.names).index(name))


def _first_order(variables: Sequence[ModelVariable]) -> Any:
    return (c_int * len(variables))(*(1 for _ in variables))


def _converted(call: Call) -> Call:
    return call._replace(run=_converting(call.run, call.arguments[-1], call.factors)) if call.factors else call


def _converting(get_values: Callable[[], int], place: Any, factors: Sequence[float]) -> Callable[[], int]:
    def get() -> int:
        status = get_values()
        place[:] = [value * factor for value, factor in zip(place, factors, strict=True)]
        return status

    return get


def advance(instance: Instance, row: bytearray, step_size: c_double) -> Call:
    """The call that makes one communication step from the time in the row, of the size in s at that moment."""
    call = _bound(instance, "fmi2DoStep", c_double.from_buffer(row), step_size, c_int(1))
    return call._replace(step_size=step_size)


def _by_type(variables: Sequence[ModelVariable]) -> list[tuple[str, list[ModelVariable]]]:
    alike = [(kind, [v for v in variables if type_of(v) == kind]) for kind in KINDS]
    return [(kind, group) for kind, group in alike if group]


def _access(instance: Instance, function: str, variables: Sequence[ModelVariable], place: Any, *orders: Any) -> Call:
    references = (c_uint * len(variables))(*(v.valueReference for v in variables))
    factors = [instance.interface.factors.get(v.name, 1.0) for v in variables]
    call = _bound(instance, function, references, c_size_t(len(variables)), *orders, place)
    call = call._replace(names=[v.name for v in variables])
    return call._replace(factors=factors) if any(factor != 1.0 for factor in factors) else call


def _bound(instance: Instance, function: str, *arguments: Any) -> Call:
    return Call(instance, function, partial(instance.function(function), instance.component, *arguments), arguments)
