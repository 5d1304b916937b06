"""What an output depends on, found by calling the block's own functions with symbols."""

from collections.abc import Callable, Iterable, Iterator
from itertools import product
from typing import Any, NamedTuple

from ..block.declaration import Boolean, is_tuple, variables
from ..block.types import Block, ContinuousBlock
from ..symbol import Symbol
from .states import event_indicators, rate_name, state_name


class Dependent(Symbol):
    """A value that remembers which variables it was computed from; both values of a `where` count."""

    def __init__(self, sources: frozenset[str] = frozenset()) -> None:
        self.sources = sources

    def after(self, operation: str, *operands: Any) -> "Dependent":
        return Dependent(_union(map(sources, operands)))


def sources(value: Any) -> frozenset[str]:
    """Names of the variables that a value was computed from; none for a number."""
    return value.sources if isinstance(value, Dependent) else frozenset()


def _union(sets: Iterable[frozenset[str]]) -> frozenset[str]:
    return frozenset[str]().union(*sets)


def _symbols(record: type[Any], named: bool, name: Callable[[str], str] = str) -> Any:
    """A record of symbols, which are their own sources, by the names that the FMU gives them, or have none."""
    return record(*(Dependent(frozenset({name(field)}) if named else frozenset()) for field in record._fields))


def _without_sources(value: Any) -> Any:
    """The same state with a symbol without sources in the place of every number."""
    if not is_tuple(value):
        return Dependent()
    items = [_without_sources(item) for item in value]
    make = getattr(type(value), "_make", tuple)
    return make(items)


MOST_SWITCHES = 8
"""Boolean parameters whose values are tried together; with more, the others count as unknown."""


def _cases(block: Block) -> Iterator[dict[str, bool]]:
    """The values that the Boolean parameters can have; what one chooses and bars at the same time is no dependency."""
    names = [v.name for v in variables(block.Parameters) if isinstance(v.declaration, Boolean)][:MOST_SWITCHES]
    for values in product((False, True), repeat=len(names)):
        yield dict(zip(names, values, strict=True))


Dependencies = dict[str, frozenset[str]]
"""For every unknown of an FMU the names of what it depends on."""


def _sources_in_all(names: Iterable[str], cases: Iterable[Any]) -> Dependencies:
    """For every name what it was computed from in one or another of several records with these names."""
    columns = zip(*cases, strict=True)
    return {name: _union(map(sources, values)) for name, values in zip(names, columns, strict=True)}


def output_dependencies(block: Block) -> Dependencies:
    """For every output the inputs that it depends on directly."""
    start = block.start(block.Input(), block.Parameters())
    return _after_start(block, block.output, _without_sources(start), block.Output._fields)


class Exchanged(NamedTuple):
    """For every output, derivative of a state and event indicator the inputs and states that it depends on directly."""

    outputs: Dependencies
    rates: Dependencies
    indicators: Dependencies


def exchanged_dependencies(block: ContinuousBlock) -> Exchanged:
    """What a host that integrates is told."""
    x = _symbols(block.State, True, state_name)
    return Exchanged(
        _after_start(block, block.output, x, block.Output._fields),
        _after_start(block, block.derivative, x, _rate_names(block)),
        _after_start(block, block.event_indicators, x, [v.name for v in event_indicators(block)]),
    )


def _rate_names(block: ContinuousBlock) -> list[str]:
    return [rate_name(state_name(field)) for field in block.State._fields]


def _after_start(block: Block, function: Callable[..., Any], x: Any, names: Iterable[str]) -> Dependencies:
    u, p = _symbols(block.Input, named=True), _symbols(block.Parameters, named=False)
    return _sources_in_all(names, (function(x, u, p._replace(**case)) for case in _cases(block)))


def initial_dependencies(block: Block) -> Dependencies:
    """For every output the inputs and parameters that its initial value depends on."""
    return _at_start(block, block.output, block.Output._fields)


def initial_state_dependencies(block: ContinuousBlock) -> Dependencies:
    """For every state, and every derivative of one, the inputs and parameters that its initial value depends on."""
    started = _at_start(block, _state, map(state_name, block.State._fields))
    return started | _at_start(block, block.derivative, _rate_names(block))


def _state(x: Any, u: Any, p: Any) -> Any:
    return x


def _at_start(block: Block, function: Callable[..., Any], names: Iterable[str]) -> Dependencies:
    names = tuple(names)
    u, p = _symbols(block.Input, named=True), _symbols(block.Parameters, named=True)
    every = _sources_in_all(names, [function(block.start(u, p), u, p)])
    chosen = [p._replace(**case) for case in _cases(block)]
    known = _sources_in_all(names, (function(block.start(u, p), u, p) for p in chosen))
    switches = frozenset(next(_cases(block)))
    return {name: known[name] | (every[name] & switches) for name in every}
