"""Declaring the quantities of a block: type, unit, meaning and bounds, each on one line.

    class Parameters(NamedTuple):
        J_1: Annotated[float, Real("kg.m2", "inertia of the motor side", 1e-4, 10.0)] = 0.055

The value behind the `=` is the start value. Everything that others say about a variable (the FMI
variable, its checks, the tables of the documentation) is read from here with `variables`.
"""

import math
from collections import namedtuple
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeGuard, TypeVar, get_type_hints


@dataclass(frozen=True)
class Real:
    """A floating-point quantity with its unit (Modelica notation, "1" for none) and bounds.

    Attributes:
        search: range, for the default car, in which a search for the best value stays; None: it is given, as what
            belongs to the car is, or computed. Where it begins above 0 the search goes by factors.
        tunable: of a parameter: a run may change it, and the state goes on without a jump.
    """

    unit: str
    description: str
    minimum: float = -math.inf
    maximum: float = math.inf
    nominal: float | None = None
    search: tuple[float, float] | None = None
    tunable: bool = False


@dataclass(frozen=True)
class Integer:
    """A whole number and its bounds."""

    description: str
    minimum: int = -(2**31)
    maximum: int = 2**31 - 1


@dataclass(frozen=True)
class Boolean:
    """True or false."""

    description: str


@dataclass(frozen=True)
class Enumeration:
    """A whole number from 1 to len(items); item k has the name items[k - 1] and a meaning."""

    name: str
    description: str
    items: tuple[tuple[str, str], ...]


Declaration = Real | Integer | Boolean | Enumeration

Record = tuple[Any, ...]
"""A named tuple of quantities, of whichever block."""


def is_tuple(value: object) -> TypeGuard[tuple[Any, ...]]:
    """Whether a value is a tuple, named or not, rather than a number."""
    return isinstance(value, tuple)


class Quantity(NamedTuple):
    """One declared quantity: its name, its declaration, its start value (None if it has none)."""

    name: str
    declaration: Declaration
    start: Any


def variables(record: type[Any]) -> tuple[Quantity, ...]:
    """The declared quantities of a NamedTuple class, in the order of its fields.

    A field that is itself a record is left out; it declares its own quantities.

    Raises:
        TypeError: a field has no declaration and is not a record.
    """
    hints = get_type_hints(record, include_extras=True)
    defaults = record._field_defaults
    quantities: list[Quantity] = []
    for name, hint in hints.items():
        declared = [m for m in getattr(hint, "__metadata__", ()) if isinstance(m, Declaration)]
        if not declared and (isinstance(hint, TypeVar) or hasattr(hint, "_fields")):
            continue
        if not declared:
            raise TypeError(f"{record.__module__}.{record.__name__}.{name} has no declaration")
        quantities.append(Quantity(name, declared[0], defaults.get(name)))
    return tuple(quantities)


def merged(name: str, *records: type[Any]) -> type[Any]:
    """A NamedTuple class with the fields of several, each name once, with declarations and start values.

    Raises:
        TypeError: two records mean different things by one name.
    """
    fields: dict[str, tuple[Any, Any]] = {}
    for record in records:
        for field, declared in _fields(record).items():
            if fields.setdefault(field, declared) != declared:
                raise TypeError(f"{record.__module__}.{record.__name__}.{field} is declared otherwise elsewhere")
    return _record(name, fields)


def with_defaults(record: type[Any], values: Mapping[str, Any]) -> type[Any]:
    """A NamedTuple class like this one with other start values, by the names of its fields."""
    fields = {field: (hint, values.get(field, start)) for field, (hint, start) in _fields(record).items()}
    return _record(record.__name__, fields)


def without(record: type[Any], names: Collection[str]) -> type[Any]:
    """A NamedTuple class like this one, but for the fields of these names.

    Raises:
        TypeError: it does not have one of them.
    """
    fields = _fields(record)
    if unknown := sorted(set(names) - fields.keys()):
        raise TypeError(f"{record.__module__}.{record.__name__} has no field {unknown[0]}")
    return _record(record.__name__, {name: fields[name] for name in fields if name not in names})


def quantities(name: str, declared: Mapping[str, tuple[Any, Any]]) -> type[Any]:
    """A NamedTuple class with these fields: name -> declaration, as an Annotated type, and start value."""
    return _record(name, declared)


def _fields(record: type[Any]) -> dict[str, tuple[Any, Any]]:
    """Declaration and start value of each field."""
    hints = get_type_hints(record, include_extras=True)
    return {field: (hint, record._field_defaults[field]) for field, hint in hints.items()}


def _record(name: str, fields: Mapping[str, tuple[Any, Any]]) -> type[Any]:
    starts = [start for _, start in fields.values()]
    record = namedtuple(name, fields, defaults=starts)  # pyright: ignore[reportUntypedNamedTuple]
    record.__annotations__ = {field: hint for field, (hint, _) in fields.items()}
    return record
