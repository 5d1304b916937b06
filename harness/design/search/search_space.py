"""What is searched of a controller, as its parameters are declared: which ones, from where, and how far."""

from collections.abc import Mapping, Sequence
from functools import cache
from math import exp, isclose, log
from pathlib import Path
from typing import Any, NamedTuple

from fmublocks.description.variables import Variable, interface
from toolground.errors import UserError

from ....fmus.building.builds import fmu_of
from ..design import design, literal_observer
from ..design_weights import records

DIGITS = 6
"""Significant digits of a candidate, which are those of a file of gains."""

SAME = 1e-5
"""Relative difference of what is computed and what is stored with DIGITS digits."""


class Searched(NamedTuple):
    """A parameter that is searched.

    Its coordinate is 0 at the start. In a range that begins above 0 it counts factors e, in others halves of the range.
    """

    name: str
    start: float
    low: float
    high: float

    def coordinate(self, value: float) -> float:
        return log(value / self.start) if self.low > 0.0 else 2.0 * (value - self.start) / (self.high - self.low)

    def value(self, coordinate: float) -> float:
        """The value to DIGITS digits, within the range."""
        half = 0.5 * (self.high - self.low)
        value = self.start * exp(coordinate) if self.low > 0.0 else self.start + coordinate * half
        return rounded(clipped(value, self.low, self.high))


class Space(NamedTuple):
    """What is searched of a controller for a car.

    Attributes:
        searched: its parameters that are declared with a range to search in.
        computed: what Riccati equations and formulas say of its others.
    """

    searched: tuple[Searched, ...]
    computed: Mapping[str, float]

    @property
    def start(self) -> tuple[float, ...]:
        """The values of the searched parameters from which the search begins."""
        return tuple(parameter.value(0.0) for parameter in self.searched)

    def coordinates(self, values: Sequence[float]) -> list[float]:
        return [parameter.coordinate(value) for parameter, value in zip(self.searched, values, strict=True)]

    def values(self, coordinates: Sequence[float]) -> tuple[float, ...]:
        return tuple(parameter.value(float(x)) for parameter, x in zip(self.searched, coordinates, strict=True))

    def parameters(self, values: Sequence[float]) -> dict[str, float]:
        """All designed parameters of the controller with these values of the searched ones."""
        return {**self.computed, **{p.name: value for p, value in zip(self.searched, values, strict=True)}}


def declared_parameters(controller: str) -> dict[str, Variable]:
    """The parameters of a controller by name, as they are declared."""
    return {v.name: v for v in interface(fmu_of(controller).block) if v.causality == "parameter"}


def space(controller: str, car: Mapping[str, Any]) -> Space:
    """What is searched of a controller for a car.

    A parameter is computed where what is computed for the default car, for our controller or the paper's observer, is
    its start value. A range is that of the default car, times what the formulas make of the start here and there.

    Args:
        controller: by name.
        car: entries of the vehicle file.

    Raises:
        UserError: the controller has nothing to search.
        DesignError: see `harness.design.design.design`.
    """
    declared = declared_parameters(controller)
    here, scale = {}, {}
    for computed, usual in zip(_computed(car), _usual(), strict=True):
        for name in usual:
            if name in declared and isclose(declared[name].start, usual[name], rel_tol=SAME):
                here[name], scale[name] = computed[name], computed[name] / usual[name]
    searched = [
        _searched(variable, scale.get(name, 1.0))
        for name, variable in declared.items()
        if getattr(variable.declaration, "search", None)
    ]
    if not searched:
        raise UserError(
            f"{Path(controller).stem} has no parameter that is searched: none is declared with a range, as "
            "Real(..., search=(0.5, 5.0))"
        )
    names = {parameter.name for parameter in searched}
    return Space(tuple(searched), {name: rounded(value) for name, value in here.items() if name not in names})


def _computed(car: Mapping[str, Any]) -> tuple[dict[str, float], ...]:
    return design(car), literal_observer(*records(car))


@cache
def _usual() -> tuple[dict[str, float], ...]:
    return _computed({})


def _searched(variable: Variable, scale: float) -> Searched:
    declaration: Any = variable.declaration
    low, high = (clipped(scale * bound, *variable.bounds()) for bound in declaration.search)
    return Searched(variable.name, clipped(scale * variable.start, low, high), low, high)


def clipped(value: float, low: float, high: float) -> float:
    return min(max(value, low), high)


def rounded(value: float) -> float:
    """To as many significant digits as a file of gains has."""
    return float(f"{value:.{DIGITS}g}")
