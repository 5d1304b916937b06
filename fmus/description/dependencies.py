"""What an output depends on, found by calling the block's own functions with symbols."""

from typing import Any

from models.block.types import Block, SampledBlock


class Symbol:
    """A value that remembers which variables it was computed from.

    It follows the protocol of `models.block.operators`; both values of a `where` count.
    """

    def __init__(self, sources: frozenset[str] = frozenset()) -> None:
        self.sources = sources

    def _joined(self, *others: Any) -> "Symbol":
        return Symbol(self.sources.union(*(sources(other) for other in others)))

    def __bool__(self) -> bool:
        raise TypeError("a model function branches on data; it must call `where` of models.block.operators")

    __add__ = __radd__ = __sub__ = __rsub__ = __mul__ = __rmul__ = _joined
    __truediv__ = __rtruediv__ = __pow__ = __rpow__ = _joined
    __mod__ = __rmod__ = _joined
    __lt__ = __le__ = __gt__ = __ge__ = _joined
    __eq__ = __ne__ = _joined  # pyright: ignore[reportAssignmentType]
    where = logical_and = logical_or = logical_not = _joined
    __neg__ = __pos__ = __abs__ = sin = cos = atan = tanh = sqrt = log = floor = _joined
    __hash__ = object.__hash__


def sources(value: Any) -> frozenset[str]:
    """Names of the variables that a value was computed from; none for a number."""
    return value.sources if isinstance(value, Symbol) else frozenset()


def _symbols(record: type, named: bool) -> Any:
    """A record of symbols, which are their own sources or have none."""
    fields = record._fields  # pyright: ignore[reportAttributeAccessIssue]
    return record(*(Symbol(frozenset({name}) if named else frozenset()) for name in fields))


def _without_sources(value: Any) -> Any:
    """The same state with a symbol without sources in the place of every number."""
    if not isinstance(value, tuple):
        return Symbol()
    items = [_without_sources(item) for item in value]
    make = getattr(type(value), "_make", tuple)
    return make(items)


def output_dependencies(block: Block) -> dict[str, frozenset[str]]:
    """For every output the inputs that it depends on directly; none for a sampled block."""
    if isinstance(block, SampledBlock):
        return {name: frozenset() for name in block.Output._fields}
    start = block.start(block.Input(), block.Parameters())
    u, p = _symbols(block.Input, named=True), _symbols(block.Parameters, named=False)
    y = block.output(_without_sources(start), u, p)
    return {name: sources(value) for name, value in zip(y._fields, y, strict=True)}


def initial_dependencies(block: Block) -> dict[str, frozenset[str]]:
    """For every output the inputs and parameters that its initial value depends on."""
    u, p = _symbols(block.Input, named=True), _symbols(block.Parameters, named=True)
    y = block.output(block.start(u, p), u, p)
    return {name: sources(value) for name, value in zip(y._fields, y, strict=True)}
