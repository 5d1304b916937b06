"""Faults in Python: what may stand in place of a node of the syntax tree."""

import ast
from collections.abc import Iterator
from copy import deepcopy
from typing import Any

COMPARISONS: dict[type, tuple[type, ...]] = {
    ast.Lt: (ast.LtE, ast.GtE),
    ast.LtE: (ast.Lt, ast.Gt),
    ast.Gt: (ast.GtE, ast.LtE),
    ast.GtE: (ast.Gt, ast.Lt),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
}
ARITHMETIC: dict[type, type] = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult}
NAMES = {"minimum": "maximum", "logical_and": "logical_or", "max": "min", "ceil": "floor"}
NAMES |= {other: name for name, other in NAMES.items()}
CHOICES = {"where", "branch"}
SAYING = {"frozen", "kw_only", "slots", "strict"}
"""Arguments that only say what holds anyway."""
LEFT_OUT = {"clip", "abs", "logical_not", "minimum", "maximum", "max", "min"}


def number(value: float) -> Iterator[ast.Constant]:
    """Other numbers in its place."""
    match value:
        case bool():
            yield ast.Constant(not value)
        case int():
            yield ast.Constant(0 if value == 1 else value + 1)
        case 0.0:
            yield ast.Constant(1.0)
        case _:
            yield from (ast.Constant(float(f"{factor * value:.12g}")) for factor in (1.2, 0.8))


def replacements(node: ast.AST) -> Iterator[ast.AST | None]:
    """None stands for leaving a statement out."""

    def with_(**fields: Any) -> ast.AST:
        other = deepcopy(node)
        for name, value in fields.items():
            setattr(other, name, value)
        return other

    match node:
        case ast.Constant(value=bool() | int() | float() as value):
            yield from number(value)
        case ast.Compare(ops=[operator]):
            yield from (with_(ops=[other()]) for other in COMPARISONS.get(type(operator), ()))
        case ast.BinOp(op=operator) if type(operator) in ARITHMETIC:
            yield with_(op=ARITHMETIC[type(operator)]())
        case ast.BoolOp(op=operator):
            yield with_(op=ast.Or() if isinstance(operator, ast.And) else ast.And())
        case ast.UnaryOp(op=ast.USub() | ast.Not(), operand=operand):
            yield operand
        case ast.IfExp(body=body, orelse=otherwise):
            yield with_(body=otherwise, orelse=body)
        case ast.Name(id=name) if name in NAMES:
            yield with_(id=NAMES[name])
        case ast.Attribute(attr=name) if name in NAMES:
            yield with_(attr=NAMES[name])
        case ast.Call(func=ast.Name(id=name), args=[condition, value, otherwise]) if name in CHOICES:
            yield with_(args=[condition, otherwise, value])
        case ast.Call(func=ast.Name(id=name), args=[value, *_]) if name in LEFT_OUT:
            yield value
        case ast.AugAssign() | ast.Assign(targets=[ast.Attribute()]) | ast.Expr(value=ast.Call()):
            yield None
        case ast.If(body=[ast.Raise()], orelse=[]):
            yield None
        case ast.Assign(targets=[ast.Name(id=name)], value=value):
            if any(isinstance(part, ast.Name) and part.id == name for part in ast.walk(value)):
                yield None


def parts(node: ast.AST, has_state: bool = False) -> Iterator[tuple[ast.AST, ast.AST | None]]:
    """Every node that computes (no annotation, no docstring) with each of its faults.

    In a function of the state x, a field of the next state may also stay what it is.
    """
    match node:
        case ast.FunctionDef(args=ast.arguments(args=arguments, defaults=defaults), body=body):
            has_state = [argument.arg for argument in arguments[:1]] == ["x"]
            children: list[ast.AST] = [*defaults, *body]
        case ast.AnnAssign(value=value):
            children = [value] if value else []
        case ast.keyword(arg=name) if name in SAYING:
            children = []
        case ast.JoinedStr():  # Python 3.11 does not know where its parts stand
            children = []
        case _:
            children = list(ast.iter_child_nodes(node))
    yield from ((node, fault) for fault in replacements(node))
    if has_state and isinstance(node, ast.Call) and ast.unparse(node.func).endswith(("State", "x._replace")):
        for field in node.keywords:
            old = ast.Attribute(ast.Name("x"), str(field.arg))
            if ast.unparse(field.value) != ast.unparse(old):
                yield field.value, old
    for child in children:
        yield from parts(child, has_state)


def faults(source: str) -> Iterator[tuple[int, str, str]]:
    """Place in bytes, old and new text of every fault."""
    starts, code = [0], source.encode()
    for line in code.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    for node, fault in parts(ast.parse(source)):
        place, end = (starts[line - 1] + column for line, column in _ends(node))
        yield place, code[place:end].decode(), "pass" if fault is None else ast.unparse(fault)


def _ends(node: Any) -> tuple[tuple[int, int], tuple[int, int]]:
    """Line, and column in bytes, of its beginning and of its end."""
    return (node.lineno, node.col_offset), (node.end_lineno, node.end_col_offset)
