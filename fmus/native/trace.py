"""The functions of a block as CasADi functions, found by calling them with symbols.

While a block is called CasADi does not simplify, so that the expressions hold the operations of the
Python functions in their order and round as they do. Only derivatives, which Python does not have,
are simplified.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any, NamedTuple

import casadi

from ...models.block.declaration import is_tuple
from ...models.block.frame import count, layout
from ...models.block.types import Block, ContinuousBlock
from .symbol import CasadiSymbol, expression


class Traced(NamedTuple):
    """One function of a block.

    Attributes:
        function: its inputs are the flattened records `arguments`, its output the flattened `result`.
        arguments: of x, u, y, p, and dx, du, dp for rates of change of these, h for a time.
        result: x, dx, ddx, y, dy or, for numbers that are no record, z.
    """

    name: str
    function: casadi.Function
    arguments: tuple[str, ...]
    result: str


def trace(block: Block) -> tuple[Traced, ...]:
    """All functions of a block; for a continuous one also how fast their values change.

    `output_rate` is for given rates of x and u. The tangents are for changes of all that a function depends on.

    Raises:
        TypeError: a function branches on data, or does what symbols cannot.
    """
    x0 = block.start(block.Input(), block.Parameters())
    symbols = {"x": _symbols("x", x0), "u": _symbols("u", block.Input()), "p": _symbols("p", block.Parameters())}
    x, u, p = symbols.values()
    with exact():
        results: dict[str, tuple[Sequence[str], str, Any]] = {
            "start": ("up", "x", block.start(u, p)),
            "output": ("xup", "y", block.output(x, u, p)),
        }
        if isinstance(block, ContinuousBlock):
            results["derivative"] = ("xup", "dx", block.derivative(x, u, p))
            if indicators := block.event_indicators(x, u, p):
                results["event_indicators"] = ("xup", "z", indicators)
            if block.solution:
                symbols |= {"du": _symbols("du", block.Input()), "h": CasadiSymbol(casadi.SX.sym("h"))}
                solved = block.solution(x, u, symbols["du"], p, symbols["h"])
                results["solution"] = (("x", "u", "du", "p", "h"), "z", solved)
            if block.next_event:
                results["next_event"] = ("xup", "z", (block.next_event(x, u, p),))
        else:
            results["update"] = ("xup", "next", block.update(x, u, p))
    vectors = {name: _vector(record if is_tuple(record) else (record,)) for name, record in symbols.items()}
    traced = [
        _traced(name, {argument: vectors[argument] for argument in arguments}, result, _vector(values))
        for name, (arguments, result, values) in results.items()
    ]
    if isinstance(block, ContinuousBlock):
        xup = {name: vectors[name] for name in "xup"}
        traced.append(_rate("output_rate", "dy", _vector(results["output"][2]), xup, ("x", "u")))
        for name in ("output", "derivative", "start"):
            arguments, result, values = results[name]
            own = {argument: vectors[argument] for argument in arguments}
            traced.append(_rate(f"{name}_tangent", f"d{result}", _vector(values), own, tuple(arguments)))
    return tuple(traced)


@contextmanager
def exact() -> Iterator[None]:
    """While it lasts CasADi keeps every operation as it is written."""
    before = casadi.GlobalOptions.getSimplificationOnTheFly()
    casadi.GlobalOptions.setSimplificationOnTheFly(False)
    try:
        yield
    finally:
        casadi.GlobalOptions.setSimplificationOnTheFly(before)


def leaves(value: Any) -> list[Any]:
    """The numbers in nested tuples, in their order."""
    return [leaf for item in value for leaf in leaves(item)] if is_tuple(value) else [value]


def trace_frame(block: Block) -> Traced:
    """What the bits of the signals of the block's frame hold, in the layout of its start values.

    Raises:
        ValueError: the bits of a signal do not hold its largest value.
    """
    declared = block.Parameters()
    x0 = block.start(block.Input(), declared)
    p, y = _symbols("p", declared), _symbols("y", block.output(x0, block.Input(), declared))
    contents = [(content, layout(content, declared)) for content in block.frames[0].contents]
    with exact():
        counts = tuple(count(content, of, getattr(y, content.quantity), p) for content, of in contents)
    return _traced("frame", {"y": _vector(y), "p": _vector(p)}, "z", _vector(counts))


def _symbols(name: str, template: Any) -> Any:
    """A symbol in the place of every number."""
    if not is_tuple(template):
        return CasadiSymbol(casadi.SX.sym(name))
    make = getattr(type(template), "_make", tuple)
    return make([_symbols(name, item) for item in template])


def _vector(record: Any) -> casadi.SX:
    return casadi.vertcat(*map(expression, leaves(record)))


def _traced(name: str, arguments: dict[str, casadi.SX], result: str, value: casadi.SX) -> Traced:
    return Traced(name, casadi.Function(name, list(arguments.values()), [value]), tuple(arguments), result)


def _rate(name: str, result: str, value: casadi.SX, vectors: dict[str, casadi.SX], moving: tuple[str, ...]) -> Traced:
    """The rate of change of a value while the vectors `moving` change at given rates."""
    rates = {f"d{of}": casadi.SX.sym(f"d{of}", vectors[of].numel()) for of in moving}
    at = casadi.vertcat(*(vectors[of] for of in moving))
    rate = casadi.densify(casadi.jtimes(value, at, casadi.vertcat(*rates.values())))
    return _traced(name, vectors | rates, result, rate)
