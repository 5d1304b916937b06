"""The functions of a block as operations, found by calling them with symbols.

The operations are those of the Python functions in their order, and round as they do.
"""

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

from ..block.declaration import is_tuple
from ..block.frame import count, layout
from ..block.types import Block, ContinuousBlock
from .arithmetic import Node, Recording, TracedGraph, TracedSymbol, node_of
from .rates import rates


class Traced(NamedTuple):
    """One function of a block.

    Attributes:
        recording: has its operations, with those of other functions.
        vectors: numbers of its inputs there, the flattened records `arguments`.
        values: nodes of its output, the flattened `result`.
        arguments: of x, u, y, p, and dx, du, dp for rates of change of these, h for a time.
        result: x, dx, ddx, y, dy or, for numbers that are no record, z.
    """

    name: str
    recording: Recording
    vectors: tuple[int, ...]
    values: tuple[int, ...]
    arguments: tuple[str, ...]
    result: str

    def graph(self, inputs: Sequence[Sequence[str]]) -> TracedGraph:
        """Its operations alone.

        Args:
            inputs: what C calls each number of the arguments.
        """
        return TracedGraph(self.recording, self.values, self.vectors, inputs)


def trace(block: Block) -> tuple[Traced, ...]:
    """All functions of a block; for a continuous one also how fast their values change.

    `output_rate` is for given rates of x and u. The tangents are for changes of all that a function depends on.

    Raises:
        TypeError: a function branches on data, or does what symbols cannot.
    """
    vectors = _Vectors()
    u, p = vectors.of("u", block.Input()), vectors.of("p", block.Parameters())
    x = vectors.of("x", block.start(block.Input(), block.Parameters()))
    results: dict[str, tuple[Sequence[str], str, Any]] = {
        "start": ("up", "x", block.start(u, p)),
        "output": ("xup", "y", block.output(x, u, p)),
    }
    if isinstance(block, ContinuousBlock):
        results["derivative"] = ("xup", "dx", block.derivative(x, u, p))
        if indicators := block.event_indicators(x, u, p):
            results["event_indicators"] = ("xup", "z", indicators)
        if block.solution:
            du, h = vectors.of("du", block.Input()), vectors.of("h", 0.0)
            results["solution"] = (("x", "u", "du", "p", "h"), "z", block.solution(x, u, du, p, h))
        if block.next_event:
            results["next_event"] = ("xup", "z", (block.next_event(x, u, p),))
    else:
        results["update"] = ("xup", "next", block.update(x, u, p))
    traced = [vectors.traced(name, arguments, result, value) for name, (arguments, result, value) in results.items()]
    if isinstance(block, ContinuousBlock):
        by_name = {function.name: function for function in traced}
        traced.append(vectors.rate("output_rate", by_name["output"], ("x", "u")))
        for name in ("output", "derivative", "start"):
            traced.append(vectors.rate(f"{name}_tangent", by_name[name], by_name[name].arguments))
    return tuple(traced)


def leaves(value: Any) -> list[Any]:
    """The numbers in nested tuples, in their order."""
    return [leaf for item in value for leaf in leaves(item)] if is_tuple(value) else [value]


def trace_frame(block: Block) -> Traced:
    """What the bits of the signals of the block's frame hold, in the layout of its start values.

    Raises:
        ValueError: the bits of a signal do not hold its largest value.
    """
    declared, vectors = block.Parameters(), _Vectors()
    x0 = block.start(block.Input(), declared)
    y, p = vectors.of("y", block.output(x0, block.Input(), declared)), vectors.of("p", declared)
    contents = [(content, layout(content, declared)) for content in block.frames[0].contents]
    counts = tuple(count(content, of, getattr(y, content.quantity), p) for content, of in contents)
    return vectors.traced("frame", "yp", "z", counts)


class _Vectors:
    """Records of symbols, by the letters of the arguments, and what is computed from them."""

    def __init__(self) -> None:
        self._recording = Recording()
        self._nodes: dict[str, list[int]] = {}

    def of(self, name: str, template: Any) -> Any:
        """A record with symbols in the place of the numbers of a template."""
        return _filled(template, (TracedSymbol(self._recording, k) for k in self._vector(name, len(leaves(template)))))

    def _vector(self, name: str, length: int) -> list[int]:
        """The nodes of its numbers."""
        if name not in self._nodes:
            places = [(len(self._nodes), element) for element in range(length)]
            self._nodes[name] = [self._recording.number(Node("INPUT", (), place)) for place in places]
        return self._nodes[name]

    def traced(self, name: str, arguments: Sequence[str], result: str, value: Any) -> Traced:
        """A function of records."""
        return self._function(name, arguments, result, [node_of(leaf, self._recording) for leaf in leaves(value)])

    def rate(self, name: str, of: Traced, moving: Sequence[str]) -> Traced:
        """How fast the values of a function change while some of its arguments change at given rates."""
        moves: dict[int, int] = {}
        for argument in moving:
            nodes = self._nodes[argument]
            moves |= dict(zip(nodes, self._vector(f"d{argument}", len(nodes)), strict=True))
        arguments = (*of.arguments, *(f"d{argument}" for argument in moving))
        return self._function(name, arguments, f"d{of.result}", rates(self._recording, of.values, moves))

    def _function(self, name: str, arguments: Sequence[str], result: str, values: Sequence[int]) -> Traced:
        vectors = tuple(list(self._nodes).index(argument) for argument in arguments)
        return Traced(name, self._recording, vectors, tuple(values), tuple(arguments), result)


def _filled(template: Any, symbols: Iterator[TracedSymbol]) -> Any:
    if not is_tuple(template):
        return next(symbols)
    return getattr(type(template), "_make", tuple)([_filled(item, symbols) for item in template])
