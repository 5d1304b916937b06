"""One source: the model functions give with symbols what they give with floats."""

import math
import operator
from collections.abc import Callable
from typing import Any, cast

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from driveline.models import (
    damping_controller,
    motor_torque_loop,
    two_mass_driveline,
    validation_vehicle,
    wheel_speed_can,
)
from driveline.models.block import operators
from driveline.models.block.declaration import Boolean, Integer, Quantity, Real, variables
from driveline.models.block.runner import runner
from driveline.models.block.types import Block

BLOCKS = [
    model.BLOCK
    for model in (
        two_mass_driveline,
        validation_vehicle,
        motor_torque_loop,
        wheel_speed_can,
        damping_controller,
    )
]
every_block = pytest.mark.parametrize("block", BLOCKS, ids=lambda block: block.name)


class Symbol:
    """A number that nobody may look at: it can be calculated with, but no `if` can read it."""

    def __init__(self, value: Any) -> None:
        self.value = value

    def __bool__(self) -> bool:
        raise TypeError("a model function branches on data")

    __hash__ = object.__hash__

    def where(self, value: Any, otherwise: Any) -> "Symbol":
        return Symbol(unpacked(value) if self.value else unpacked(otherwise))

    def logical_and(self, other: Any) -> "Symbol":
        return Symbol(self.value and unpacked(other))

    def logical_or(self, other: Any) -> "Symbol":
        return Symbol(self.value or unpacked(other))

    def logical_not(self) -> "Symbol":
        return Symbol(not self.value)


def _forward(function: Callable[..., Any]) -> Callable[..., Symbol]:
    return lambda self, *others: Symbol(function(self.value, *map(unpacked, others)))


def _backward(function: Callable[..., Any]) -> Callable[..., Symbol]:
    return lambda self, other: Symbol(function(unpacked(other), self.value))


for _name in ("add", "sub", "mul", "truediv", "mod", "pow"):
    setattr(Symbol, f"__{_name}__", _forward(getattr(operator, _name)))
    setattr(Symbol, f"__r{_name}__", _backward(getattr(operator, _name)))
for _name in ("lt", "le", "gt", "ge", "eq", "ne", "neg", "abs"):
    setattr(Symbol, f"__{_name}__", _forward(getattr(operator, _name)))
for _name in ("sin", "cos", "atan", "tanh", "sqrt", "log", "floor"):
    setattr(Symbol, _name, _forward(getattr(math, _name)))


def packed(value: Any) -> Any:
    """Symbols in the place of all numbers of a record."""
    if not isinstance(value, tuple):
        return Symbol(value)
    return getattr(type(value), "_make", tuple)([packed(item) for item in value])


def unpacked(value: Any) -> Any:
    return value.value if isinstance(value, Symbol) else value


def numbers(value: Any) -> list[float]:
    """All numbers of a record in a row."""
    if isinstance(value, tuple):
        return [number for item in value for number in numbers(item)]
    return [float(unpacked(value))]


def drawn(variable: Quantity, rng: np.random.Generator) -> Any:
    """A value for an input: moderate, and within its bounds."""
    match variable.declaration:
        case Real(minimum=low, maximum=high):
            return float(np.clip(rng.normal(0.0, 60.0), low, high))
        case Integer():
            return int(rng.integers(0, 5))
        case Boolean():
            return bool(rng.integers(0, 2))
    raise TypeError(variable.name)


def course(block: Block, steps: int) -> list[tuple[Any, Any, Any]]:
    """States, inputs and parameters on a run with random inputs."""
    rng, p = np.random.default_rng(5), block.Parameters()
    p = p._replace(v_0=3.0, T_0=10.0) if "v_0" in p._fields else p
    inputs = [block.Input(*(drawn(v, rng) for v in variables(block.Input))) for _ in range(steps)]
    running, run = runner(block, inputs[0], p), []
    for u in inputs:
        run.append((running.x, u, p))
        running.advance(u, getattr(block, "sample_time", 0.004))
    return run


@every_block
def test_symbols_give_what_floats_give(block: Block) -> None:
    """Also a proof that nothing branches on data: a symbol has no truth value."""
    names = ("output", "derivative", "event_indicators", "update")
    for x, u, p in course(block, 60):
        assert numbers(block.start(packed(u), packed(p))) == pytest.approx(numbers(block.start(u, p)), rel=1e-12)
        for function in (getattr(block, name) for name in names if hasattr(block, name)):
            ours = numbers(function(x, u, p))
            assert numbers(function(packed(x), packed(u), packed(p))) == pytest.approx(ours, rel=1e-12, abs=1e-12)


floats = st.floats(-1e6, 1e6)


@given(a=floats, b=floats, low=floats, span=st.floats(0.0, 1e3))
def test_choices_are_those_of_python(a: float, b: float, low: float, span: float) -> None:
    assert operators.maximum(a, b) == max(a, b)
    assert operators.minimum(a, b) == min(a, b)
    assert operators.clip(a, low, low + span) == min(max(a, low), low + span)
    assert operators.sign(a) == (a > 0.0) - (a < 0.0)
    assert operators.floor(a) == math.floor(a)
    assert operators.where(a < b, a, b) == min(a, b)


@pytest.mark.parametrize("x", [math.nan, math.inf, -math.inf])
def test_what_is_not_finite_is_told_and_limited(x: float) -> None:
    assert operators.is_finite(x) is False
    assert operators.is_finite(1.7976931348623157e308) is True
    assert -1.0 <= operators.clip(x, -1.0, 1.0) <= 1.0


@given(values=st.lists(floats, min_size=2, max_size=6), position=st.floats(-2.0, 8.0))
def test_interpolation_is_linear_and_held_beyond_the_ends(values: list[float], position: float) -> None:
    expected = float(np.interp(position, range(len(values)), values))
    assert operators.interpolate(values, position) == pytest.approx(expected, rel=1e-9, abs=1e-6)
    traced = operators.interpolate(values, cast(float, Symbol(position)))
    assert unpacked(traced) == pytest.approx(expected, rel=1e-9, abs=1e-6)


def test_a_costly_branch_is_only_taken_when_needed() -> None:
    def never() -> tuple[float]:
        raise AssertionError

    assert operators.branch(True, lambda: (1.0,), never) == (1.0,)
    assert operators.branch(False, never, lambda: (2.0,)) == (2.0,)
    assert numbers(operators.branch(cast(bool, Symbol(True)), lambda: (1.0, (3.0,)), lambda: (2.0, (4.0,)))) == [
        1.0,
        3.0,
    ]
