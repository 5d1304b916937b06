"""Derivatives of traced functions are those of the operations in them."""

from collections.abc import Callable
from typing import Any

import pytest
from fmutesting.recorded import values
from fmutesting.together import together

from fmublocks.block.operators import (
    atan,
    branch,
    clip,
    cos,
    exp,
    floor,
    interpolate,
    log,
    maximum,
    sign,
    sin,
    sqrt,
    tanh,
    where,
)
from fmublocks.native.arithmetic import Node, Recording, TracedSymbol, node_of
from fmublocks.native.rates import rates

AT = (0.7, 1.9)
STEP = 1e-6


def of_two(function: Callable[..., Any]) -> tuple[Recording, list[int], list[int], int]:
    """The recording of a function of two numbers, their nodes, those of their rates, and that of the value."""
    recording = Recording()
    nodes = [recording.number(Node("INPUT", (), (vector, k))) for vector in (0, 1) for k in (0, 1)]
    value = node_of(function(*(TracedSymbol(recording, k) for k in nodes[:2])), recording)
    return recording, nodes[:2], nodes[2:], value


@together(
    "function",
    [
        lambda a, b: a + b,
        lambda a, b: a - b,
        lambda a, b: a - (-b) * a,
        lambda a, b: a * b * a,
        lambda a, b: a * a + a * a,
        lambda a, b: a / b,
        lambda a, b: 3.0 / (1.0 + a * b),
        lambda a, b: -(a / -b),
        lambda a, b: (a - b) ** 5,
        lambda a, b: abs(a - b) * b,
        lambda a, b: sin(a * b) - cos(a / b),
        lambda a, b: atan(2.0 * b) + tanh(a - b),
        lambda a, b: sqrt(a + b) * exp(-a) * log(b),
        lambda a, b: (7.0 * b + a) % 1.5,
        lambda a, b: floor(3.0 * b) * a,
        lambda a, b: where(a < b, a * b, a + b) - where(a > b, a, 0.0),
        lambda a, b: clip(a * b, 0.0, 1.0) + maximum(a, b) * sign(b),
        lambda a, b: where(a < 1.0, 2.0, b),
        lambda a, b: interpolate([a, 3.0 * b, a * b, b], b),
        lambda a, b: sum(branch(a < b, lambda: (a * b, b), lambda: (b, a))),
    ],
)
@together("along", [(1.0, 0.0), (0.0, 1.0), (0.6, -1.3)])
def test_a_rate_is_what_a_small_step_along_it_makes(function: Callable[..., Any], along: tuple[float, float]) -> None:
    recording, inputs, moving, value = of_two(function)
    (rate,) = rates(recording, [value], dict(zip(inputs, moving, strict=True)))
    slope = float(values(recording, [rate], lambda vector, k: (AT, along)[vector][k])[rate])
    ahead, behind = ([at + s * STEP * d for at, d in zip(AT, along, strict=True)] for s in (1.0, -1.0))
    assert slope == pytest.approx((function(*ahead) - function(*behind)) / (2.0 * STEP), rel=1e-7, abs=1e-7)


def test_what_does_not_move_takes_no_operation() -> None:
    recording, (a, _), (rate_of_a, _), value = of_two(lambda a, b: sin(b) * b + a)
    before = len(recording.nodes)
    assert rates(recording, [value], {a: rate_of_a}) == [rate_of_a]
    assert rates(recording, [value], {}) == [recording.constant(0.0)]
    assert len(recording.nodes) <= before + 1  # the zero


def test_what_has_no_derivative_is_refused_by_name() -> None:
    recording, inputs, moving, value = of_two(lambda a, b: a % b)
    with pytest.raises(TypeError, match="fmod has no derivative here"):
        rates(recording, [value], dict(zip(inputs, moving, strict=True)))
