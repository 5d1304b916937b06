"""Which parameters of a test `make test` leaves out."""

from collections.abc import Container, Iterable
from typing import Any

import pytest


def slow(values: Iterable[Any], *, but: Container[Any]) -> list[Any]:
    """The values of a parameter: those that are not named take over a second and find what those that are find."""
    return [value if value in but else pytest.param(value, marks=pytest.mark.slow) for value in values]
