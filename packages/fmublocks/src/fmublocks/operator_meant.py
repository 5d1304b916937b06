"""Which operator a function of the user's own needs, where it does what symbols cannot."""

import ast
import linecache
from collections.abc import Iterator
from inspect import isfunction
from pathlib import Path
from traceback import FrameSummary, extract_tb

from . import symbol
from .block import operators

OTHER_NAMES = {
    "max": "maximum",
    "fmax": "maximum",
    "min": "minimum",
    "fmin": "minimum",
    "arctan": "atan",
    "copysign": "sign",
    "isfinite": "is_finite",
    "int": "floor",
    "interp": "interpolate",
    "select": "where",
}
"""Functions of Python, math and numpy, and the operator that does the same."""

IN_PYTHON = {"fabs": "abs(x)", "pow": "x ** y", "fmod": "x % y"}
"""Functions of math, and what does the same without an operator."""

OPERATORS = {name for name, value in vars(operators).items() if isfunction(value) and name[0] != "_"} - {"symbol"}

CHOICES: dict[type[ast.AST], str] = {ast.And: "logical_and", ast.Or: "logical_or", ast.Not: "logical_not"}


def operator_meant(error: Exception) -> str:
    """What the user's own function does that symbols cannot, and what to call instead; empty: it is another error."""
    frames = extract_tb(error.__traceback__)
    branches = frames[-1].filename == symbol.__file__
    if not isinstance(error, TypeError) or not (
        branches or any(kind.__name__ in str(error) for kind in symbol.Symbol.__subclasses__())
    ):
        return ""
    own = next((frame for frame in reversed(frames) if not _of_library(frame.filename)), None)
    nodes = list(_nodes(own)) if own else []
    if not nodes:
        return ""
    if not isinstance(nodes[0], ast.Call):
        meant: str = next((name for name in map(_choice, nodes) if name), "where")
        return f"`{ast.unparse(nodes[0])}` is known in a run alone; call `operators.{meant}`"
    function = ast.unparse(nodes[0].func)
    name = function.rpartition(".")[2]
    takes = f"`{function}` takes numbers that are known when the FMU is built"
    if name in IN_PYTHON:
        return f"{takes}; write `{IN_PYTHON[name]}`"
    operator = OTHER_NAMES.get(name, name)
    if operator in OPERATORS:
        return f"{takes}; call `operators.{operator}`"
    return f"{takes}; the operators are {', '.join(sorted(OPERATORS))}"


def _of_library(file: str) -> bool:
    """Whether it is one of this package, or of one that is installed."""
    path = Path(file)
    return "site-packages" in path.parts or path.is_relative_to(Path(__file__).parent)


def _nodes(frame: FrameSummary) -> Iterator[ast.AST]:
    """What a frame was computing, and what that is part of, the outermost last."""
    start, end = (frame.lineno or 0, frame.colno or 0), (frame.end_lineno or 0, frame.end_colno or 0)
    nodes = list[ast.AST]()
    for node in ast.walk(ast.parse("".join(linecache.getlines(frame.filename)))):
        if isinstance(node, ast.expr | ast.stmt) and (node.lineno, node.col_offset) <= start:
            nodes += [node] * ((node.end_lineno or 0, node.end_col_offset or 0) >= end)
    yield from reversed(nodes)  # ast.walk goes down


def _choice(node: ast.AST) -> str:
    """The operator that does what a node does with truth values, if it does anything with them."""
    match node:
        case ast.BoolOp(op=op) | ast.UnaryOp(op=ast.Not() as op):
            return CHOICES[type(op)]
        case ast.Compare(ops=[_, _, *_]):
            return "logical_and"
    return "where" if isinstance(node, ast.If | ast.IfExp | ast.While | ast.Assert) else ""
