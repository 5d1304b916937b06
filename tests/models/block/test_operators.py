"""The operations of the models on numbers; tests/fmus/native holds those on symbols to them."""

import math

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
from fmublocks.block import operators

BLOCKS = [
    model.BLOCK
    for model in (two_mass_driveline, validation_vehicle, motor_torque_loop, wheel_speed_can, damping_controller)
]
every_block = pytest.mark.parametrize("block", BLOCKS, ids=lambda block: block.name)


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
    assert operators.element(values, position) == values[min(max(int(position), 0), len(values) - 1)]


def test_a_costly_branch_is_only_taken_when_needed() -> None:
    def never() -> tuple[float]:
        raise AssertionError

    assert operators.branch(True, lambda: (1.0,), never) == (1.0,)
    assert operators.branch(False, never, lambda: (2.0,)) == (2.0,)
