"""Which parameters of a test `make test` leaves out."""

from collections.abc import Container, Iterable
from typing import Any

import pytest


def slow(values: Iterable[Any], *, but: Container[Any]) -> list[Any]:
    """The values of a parameter: those that are not named take over a second and find what those that are find."""
    return [value if value in but else _marked(value) for value in values]


def _marked(value: Any) -> Any:
    """A tuple is the values of several parameters."""
    return pytest.param(*(value if isinstance(value, tuple) else (value,)), marks=pytest.mark.slow)
