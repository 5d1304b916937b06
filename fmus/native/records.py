"""The records of a block as C structs."""

from collections.abc import Iterator
from typing import Any, NamedTuple

from models.block.declaration import Real, Variable, variables


class Names(NamedTuple):
    """The type of a real number, and what goes before the names of structs and of functions."""

    real: str = "real"
    struct: str = ""
    function: str = ""


IN_FMU = Names()


def c_type(value: Any, names: Names) -> str:
    """Type of an element of a state: a struct of its own for a named tuple, else a number."""
    if not isinstance(value, tuple):
        return names.real
    return names.struct + type(value).__name__ if hasattr(value, "_fields") else c_type(value[0], names)


def extent(value: Any) -> str:
    """What follows the name of an element: [n] for a plain tuple, whose elements are all of one type."""
    is_array = isinstance(value, tuple) and not hasattr(value, "_fields")
    return f"[{len(value)}]{extent(value[0])}" if is_array else ""


def paths(name: str, value: Any) -> Iterator[str]:
    """What C calls each number in nested tuples, in their order."""
    if not isinstance(value, tuple):
        yield name
    elif fields := getattr(value, "_fields", ()):
        for field, item in zip(fields, value, strict=True):
            yield from paths(f"{name}.{field}", item)
    else:
        for k, item in enumerate(value):
            yield from paths(f"{name}[{k}]", item)


def structs(record: tuple[Any, ...], names: Names = IN_FMU) -> Iterator[str]:
    """The struct of a record, after those of the records in it."""
    inner = {type(value): value for item in record for value in _records(item)}
    for value in inner.values():
        yield from structs(value, names)
    declared = {variable.name: _comment(variable) for variable in variables(type(record))}
    fields = [
        (f"{c_type(value, names)} {name}{extent(value)};", declared.get(name) or _meaning(value))
        for name, value in zip(record._fields, record, strict=True)  # pyright: ignore[reportAttributeAccessIssue]
    ]
    width = max(len(field) for field, _ in fields)
    lines = "\n".join(f"    {field:{width}}  /* {comment} */" for field, comment in fields)
    yield f"typedef struct {{\n{lines}\n}} {names.struct}{type(record).__name__};"


def _records(value: Any) -> Iterator[Any]:
    """Named tuples directly in an element of a record, one of each type."""
    if hasattr(value, "_fields"):
        yield value
    elif isinstance(value, tuple):
        yield from _records(value[0])


def _meaning(value: Any) -> str:
    """The first sentence of what a record within a record says of itself."""
    return (type(value).__doc__ or "").split(".")[0]


def _comment(variable: Variable) -> str:
    declaration = variable.declaration
    unit = declaration.unit if isinstance(declaration, Real) else "1"
    return declaration.description if unit == "1" else f"{unit}: {declaration.description}"
