"""The numbers of a record."""

from collections.abc import Iterator
from typing import Any

from ..block.declaration import is_tuple


def numbers(name: str, value: Any) -> Iterator[tuple[str, Any]]:
    """The numbers in nested tuples in their order, each after what C calls it."""
    if not is_tuple(value):
        yield name, value
    elif fields := getattr(value, "_fields", ()):
        for field, item in zip(fields, value, strict=True):
            yield from numbers(f"{name}.{field}", item)
    else:
        for k, item in enumerate(value):
            yield from numbers(f"{name}[{k}]", item)
