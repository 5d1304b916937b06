"""The FMI calls of the loop, bound to their arguments once.

A row of the run is the only memory: an FMU's outputs are read straight into it, its inputs are
gathered from it. Every call returns its FMI status.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from ctypes import byref, c_bool, c_double, c_int, c_size_t, c_uint, sizeof
from functools import partial
from itertools import pairwise
from math import nan
from operator import itemgetter
from typing import Any, NamedTuple

from fmpy.fmi2 import fmi2Discard, fmi2OK, fmi2Warning
from fmpy.model_description import ModelVariable

from .input_lines import Line, slope, start
from .instance import Instance
from .interface import ACCESSES, Access, type_of
from .row_layout import KINDS, Layout


class Call(NamedTuple):
    """A bound call, what it is made of, and what an error message says of it.

    Attributes:
        run: makes the call.
        changed: takes over the values to be set and tells whether they differ from those before; None: nothing is set.
        references: of the variables whose values are set or got, as a ctypes array.
        values: those that are set or got, as a ctypes array.
        orders: of derivatives, as a ctypes array; None: the values are none.
        place: in the row, to which values are brought that do not travel as they stand there; None: there are none.
        is_number: the values are real numbers that are got and must be finite.
        sources: of the values that are set, in bytes from the beginning of the row.
        factors: what the FMU's values are multiplied by to be those of the row; empty: they are the same.
        names: of the variables whose values are set or got.
        lines: along which inputs are set to move; once they do, what was sent before is forgotten.
        slopes: of these the slopes are set, not the starts.
        step_size: in s, of calls that depend on it.
        every: it is made every so many steps.
        lead: 1: these are counted by the end of the step, 0: by its beginning.
    """

    instance: Instance
    function: str
    run: Callable[[], int]
    changed: Callable[[], bool] | None = None
    references: Any = None
    values: Any = None
    orders: Any = None
    place: Any = None
    is_number: bool = False
    sources: Sequence[int] = ()
    factors: Sequence[float] = ()
    names: Sequence[str] = ()
    lines: Sequence[Line] = ()
    slopes: bool = False
    step_size: c_double | None = None
    every: int = 1
    lead: int = 0


def sends(instance: Instance, sources: Mapping[str, str], row: bytearray, layout: Layout) -> list[Call]:
    """Calls that set the inputs, one for each type.

    Args:
        sources: `instance.variable` of an input -> column of the row that feeds it.
    """
    calls: list[Call] = []
    fed = [v for v in instance.interface.of_causality("input") if f"{instance.name}.{v.name}" in sources]
    for access, variables in instance.interface.by_access(fed).items():
        kind = KINDS[type_of(variables[0])]
        offsets = [layout.offset(sources[f"{instance.name}.{v.name}"]) for v in variables]
        call = _access(instance, "Set", access, variables, (access.ctype * len(variables))())
        changed = _change(memoryview(row).cast(kind.code), offsets, call.values, call.factors)
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
    names = frozenset(outputs)
    read = [v for v in instance.interface.of_causality("output") if v.name in names]
    for access, variables in instance.interface.by_access(read).items():
        ctype = KINDS[type_of(variables[0])].ctype
        size = sizeof(ctype)
        offsets = [layout.offset(f"{instance.name}.{v.name}") for v in variables]
        starts = [n for n, offset in enumerate(offsets) if n == 0 or offset != offsets[n - 1] + size]
        for first, end in pairwise([*starts, len(variables)]):
            place = (ctype * (end - first)).from_buffer(row, offsets[first])
            values = place if access.ctype is ctype else (access.ctype * (end - first))()
            call = _got(_access(instance, "Get", access, variables[first:end], values))
            calls.append(call if values is place else _brought(call, place))
    return calls


def receives_rates(instance: Instance, row: bytearray, outputs: Sequence[str], place: int) -> Call:
    """The call that reads output derivatives into the memory behind the row, from that byte on."""
    variables = [instance.interface.variables[name] for name in outputs]
    values = (c_double * len(variables)).from_buffer(row, place)
    function = {2: "fmi2GetRealOutputDerivatives", 3: "fmi3GetOutputDerivatives"}[instance.interface.fmi]
    references = [v.valueReference for v in variables]
    return _got(_with_units(_call(instance, function, references, values, _first_order(variables)), variables))


def moves(instance: Instance, inputs: Sequence[str], lines: Sequence[Line], step_size: c_double) -> list[Call]:
    """Calls that let inputs move along lines during the step, of the size in s at that moment."""
    variables = [instance.interface.variables[name] for name in inputs]
    interface = instance.interface
    real = ACCESSES[interface.fmi]["Real"]
    rates, starts = (c_double * len(variables))(), (c_double * len(variables))()
    begin = _access(instance, "Set", real, variables, starts)
    references = [v.valueReference for v in variables]
    if interface.fmi == 3:
        move = _call(instance, f"fmi3Set{real.name}", [interface.rates[of] for of in references], rates)
    else:
        move = _call(instance, "fmi2SetRealInputDerivatives", references, rates, _first_order(variables))

    def run_begin() -> int:
        starts[:] = [start(line, step_size.value) for line in lines]
        return begin.run()

    def run_move() -> int:
        rates[:] = [slope(line, step_size.value) for line in lines]
        for line in lines:
            line.sent.value = nan
        return move.run()

    kept = {"lines": lines, "step_size": step_size, "factors": ()}
    calls = [begin._replace(run=run_begin, **kept), move._replace(run=run_move, slopes=True, **kept)]
    return calls if any(line.after is not None for line in lines) else calls[1:]


def sent(call: Call, name: str) -> c_double:
    """Where a call that sets inputs keeps what it has set last."""
    return c_double.from_buffer(call.values, sizeof(c_double) * list(call.names).index(name))


def _first_order(variables: Sequence[ModelVariable]) -> Any:
    return (c_int * len(variables))(*(1 for _ in variables))


def _got(call: Call) -> Call:
    """A call that gets values, in the units of the row."""
    call = call._replace(is_number=call.values._type_ is c_double and not call.instance.interface.any_value)
    return call._replace(run=_converting(call.run, call.values, call.factors)) if call.factors else call


def _converting(get_values: Callable[[], int], place: Any, factors: Sequence[float]) -> Callable[[], int]:
    def get() -> int:
        status = get_values()
        place[:] = [value * factor for value, factor in zip(place, factors, strict=True)]
        return status

    return get


def _brought(call: Call, place: Any) -> Call:
    """A call that gets values which then are brought to their place in the row."""

    def get() -> int:
        status = call.run()
        place[:] = [int(value) for value in call.values]
        return status

    return call._replace(run=get, place=place)


def advance(instance: Instance, row: bytearray, step_size: c_double, every: int = 1) -> Call:
    """The call that makes one communication step from the time in the row, of the size in s at that moment; one that is
    so many steps long ends where that from the time in the row does.

    An FMU of FMI 3.0 that then asks for the end of the simulation has discarded the step, as one of FMI 2.0 does.
    """
    time, size = c_double.from_buffer(row), step_size
    if every > 1:
        time, size = c_double(), c_double()
    function = f"fmi{instance.interface.fmi}DoStep"
    do_step, component = instance.function(function), instance.component
    event, ended, early, reached = c_bool(), c_bool(), c_bool(), c_double()
    answers = byref(event), byref(ended), byref(early), byref(reached)
    keep = c_bool(True)

    def run_of_fmi3() -> int:
        status = do_step(component, time, size, keep, *answers)
        instance.slave.ended = ended.value  # type: ignore[union-attr]  # it is one of FMI 3.0
        return fmi2Discard if ended.value and status in (fmi2OK, fmi2Warning) else status

    run = partial(do_step, component, time, size, c_int(1)) if instance.interface.fmi == 2 else run_of_fmi3
    call = Call(instance, function, run, step_size=step_size)
    return call if every == 1 else _long(call, time, size, c_double.from_buffer(row), every)


def _long(call: Call, begin: c_double, size: c_double, now: c_double, every: int) -> Call:
    """The same over so many steps, the last of which begins now; steps.c computes it in the same way."""
    assert call.step_size is not None
    h = call.step_size

    def run() -> int:
        begin.value = (round(now.value / h.value) + 1.0 - every) * h.value
        size.value = h.value * every
        return call.run()

    return call._replace(run=run)


def _access(instance: Instance, verb: str, access: Access, variables: Sequence[ModelVariable], values: Any) -> Call:
    function = f"fmi{instance.interface.fmi}{verb}{access.name}"
    return _with_units(_call(instance, function, [v.valueReference for v in variables], values), variables)


def _with_units(call: Call, variables: Sequence[ModelVariable]) -> Call:
    """The call with the names of the variables and, if their units are not those of the row, with factors."""
    call = call._replace(names=[v.name for v in variables])
    factors = [call.instance.interface.factors.get(v.name, 1.0) for v in variables]
    return call._replace(factors=factors) if any(factor != 1.0 for factor in factors) else call


def _call(instance: Instance, function: str, references: Sequence[int], values: Any, orders: Any = None) -> Call:
    array, count = (c_uint * len(references))(*references), c_size_t(len(references))
    arguments = [array, count, *([] if orders is None else [orders]), values]
    if instance.interface.fmi == 3:
        arguments.append(count)
    run = partial(instance.function(function), instance.component, *arguments)
    return Call(instance, function, run, references=array, values=values, orders=orders)
