"""What an output depends on, found by calling the block's own functions with symbols."""

from typing import Any

from models.block.types import Block

from ..symbol import Symbol


class Dependent(Symbol):
    """A value that remembers which variables it was computed from; both values of a `where` count."""

    def __init__(self, sources: frozenset[str] = frozenset()) -> None:
        self.sources = sources

    def after(self, operation: str, *operands: Any) -> "Dependent":
        return Dependent(frozenset().union(*map(sources, operands)))


def sources(value: Any) -> frozenset[str]:
    """Names of the variables that a value was computed from; none for a number."""
    return value.sources if isinstance(value, Dependent) else frozenset()


def _symbols(record: type, named: bool) -> Any:
    """A record of symbols, which are their own sources or have none."""
    fields = record._fields  # pyright: ignore[reportAttributeAccessIssue]
    return record(*(Dependent(frozenset({name}) if named else frozenset()) for name in fields))


def _without_sources(value: Any) -> Any:
    """The same state with a symbol without sources in the place of every number."""
    if not isinstance(value, tuple):
        return Dependent()
    items = [_without_sources(item) for item in value]
    make = getattr(type(value), "_make", tuple)
    return make(items)


def output_dependencies(block: Block) -> dict[str, frozenset[str]]:
    """For every output the inputs that it depends on directly."""
    start = block.start(block.Input(), block.Parameters())
    u, p = _symbols(block.Input, named=True), _symbols(block.Parameters, named=False)
    y = block.output(_without_sources(start), u, p)
    return {name: sources(value) for name, value in zip(y._fields, y, strict=True)}


def initial_dependencies(block: Block) -> dict[str, frozenset[str]]:
    """For every output the inputs and parameters that its initial value depends on."""
    u, p = _symbols(block.Input, named=True), _symbols(block.Parameters, named=True)
    y = block.output(block.start(u, p), u, p)
    return {name: sources(value) for name, value in zip(y._fields, y, strict=True)}
