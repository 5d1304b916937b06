"""The source of a manoeuvre: straight lines through its points."""

from itertools import chain
from typing import Any

import numpy as np
import pytest

from driveline.models.block.runner import ContinuousRunner
from driveline.models.manoeuvre import BLOCK, NEVER, POINTS, Input

STEP_SIZE = 1e-3


def demand(*points: tuple[float, float], steps: int = 400) -> np.ndarray:
    """T_driver at k STEP_SIZE, k = 0, 1, ..., of lines through these points (time, value)."""
    pairs = chain(*(((f"time_{k}", t), (f"T_driver_{k}", y)) for k, (t, y) in enumerate(points, 1)))
    p: Any = BLOCK.Parameters(**dict(pairs))
    runner = ContinuousRunner(BLOCK, Input(), p)
    values = []
    for _ in range(steps):
        values.append(runner.output(Input()).T_driver)
        runner.advance(Input(), STEP_SIZE)
    return np.array(values)


def test_a_jump_has_its_new_value_from_its_instant_on() -> None:
    values = demand((0.0, -12.0), (0.1, -12.0), (0.1, 100.0))
    assert set(values[:100]) == {-12.0}
    assert set(values[100:]) == {100.0}


def test_between_points_it_goes_along_straight_lines_and_is_held_beyond_them() -> None:
    points = (0.05, 3.0), (0.15, -4.0), (0.2, -4.0), (0.25, 1.0 / 3.0)
    expected = np.interp(np.arange(400) * STEP_SIZE, *np.transpose(points))
    np.testing.assert_allclose(demand(*points), expected, atol=1e-13)


def test_behind_the_last_point_that_is_used_nothing_drifts_to_those_that_are_not() -> None:
    assert demand((0.0, 50.0))[-1] == 50.0
    assert demand((0.0, 50.0), (NEVER, -1e3))[-1] == 50.0
    assert demand((0.0, 50.0), (1.0, -50.0))[100] == pytest.approx(40.0)


def test_every_point_can_be_used() -> None:
    points = [(0.01 * k, float(k % 3)) for k in range(POINTS)]
    expected = np.interp(np.arange(400) * STEP_SIZE, *np.transpose(points))
    np.testing.assert_allclose(demand(*points), expected, atol=1e-12)
