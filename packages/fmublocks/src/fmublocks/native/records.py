"""The records of a block as C structs."""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from ..block.declaration import Quantity, Real, is_tuple, variables
from ..block.types import Block
from ..description.numbers import numbers
from .terms import TERMS

RECORDS = {"u": "Input", "p": "Parameters", "y": "Output", "x": "State"}
"""What C calls the records of a block, by their letters."""


class Names(NamedTuple):
    """The type of a real number, and what goes before the names of structs and of functions."""

    real: str = "real"
    struct: str = ""
    function: str = ""


IN_FMU = Names()


def records_of(block: Block) -> dict[str, Any]:
    """One of each record of a block, by their letters."""
    u, p = block.Input(), block.Parameters()
    x = block.start(u, p)
    return {"u": u, "p": p, "y": block.output(x, u, p), "x": x}


def c_type(value: Any, names: Names) -> str:
    """Type of an element of a state: a struct of its own for a named tuple, else a number."""
    if not is_tuple(value):
        return names.real
    return names.struct + type(value).__name__ if hasattr(value, "_fields") else c_type(value[0], names)


def extent(value: Any) -> str:
    """What follows the name of an element: [n] for a plain tuple, whose elements are all of one type."""
    return f"[{len(value)}]{extent(value[0])}" if is_tuple(value) and not hasattr(value, "_fields") else ""


def paths(name: str, value: Any) -> Iterator[str]:
    """What C calls each number in nested tuples, in their order."""
    return (path for path, _ in numbers(name, value))


def structs(records: Mapping[str, Any], names: Names = IN_FMU, terms: int = 0) -> Iterator[str]:
    """The structs of a block's records, each after those of the records in it, which have the names of their classes.

    Args:
        terms: how many numbers are computed from the parameters and stand behind them.

    Raises:
        ValueError: records of two classes would have one name.
    """
    written: dict[str, type] = {}
    for letter, record in records.items():
        for name, value in (*((type(inner).__name__, inner) for inner in _inner(record)), (RECORDS[letter], record)):
            if name not in written:
                yield _struct(name, value, names, terms if letter == "p" else 0)
            elif written[name] is not type(value):
                raise ValueError(f"{name} is the name of two records; to C names are all that tells them apart")
            written[name] = type(value)


def _inner(value: Any) -> Iterator[Any]:
    """The records with numbers in them that a record or a tuple holds, each after those that it holds."""
    for item in value:
        if is_tuple(item):
            yield from _inner(item)
            if hasattr(item, "_fields") and any(paths("", item)):
                yield item


def _struct(name: str, record: Any, names: Names, terms: int) -> str:
    declared = {variable.name: _comment(variable) for variable in variables(type(record))}
    fields = [
        (f"{c_type(value, names)} {field}{extent(value)};", declared.get(field) or _meaning(value))
        for field, value in zip(record._fields, record, strict=True)
        if any(paths(field, value))
    ]
    fields = fields or [(f"{names.real} none;", "in C a struct is not empty")]
    if terms:
        fields.append((f"{names.real} {TERMS}[{terms}];", "what depends on the others alone, by compute_terms"))
    width = max(len(field) for field, _ in fields)
    lines = "\n".join(f"    {field:{width}}  /* {comment} */" for field, comment in fields)
    return f"typedef struct {{\n{lines}\n}} {names.struct}{name};"


def _meaning(record: Any) -> str:
    """The first sentence of what a record within a record says of itself."""
    return " ".join((type(record).__doc__ or "").partition(".")[0].split())


def _comment(quantity: Quantity) -> str:
    declaration = quantity.declaration
    if not isinstance(declaration, Real):
        return declaration.description
    text = declaration.description if declaration.unit == "1" else f"{declaration.unit}: {declaration.description}"
    return f"{text} (tunable)" if declaration.tunable else text
