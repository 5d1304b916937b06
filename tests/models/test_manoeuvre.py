"""The source of a manoeuvre: straight lines through its points, a sine, a binary torque, and whether to damp."""

from itertools import chain
from typing import Any

import numpy as np
import pytest

from driveline.models.manoeuvre import BLOCK, NEVER, POINTS, Input, State
from fmublocks.block.runner import ContinuousRunner

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


def made(times: list[float], **parameters: float) -> list[Any]:
    p: Any = BLOCK.Parameters(**parameters)
    return [BLOCK.output(State(t), Input(), p) for t in times]


def test_a_sine_is_on_the_demand_with_its_crests_cut_off() -> None:
    sine = {"sine_amplitude": 15.0, "sine_frequency": 0.5, "sine_steepness": 2.0}
    low, flank, crest, trough = made([0.0, 1.0 / 12.0, 0.5, 1.5], T_driver_1=7.0, **sine)
    assert low.T_driver == pytest.approx(7.0)
    assert flank.T_driver == pytest.approx(7.0 + 15.0 * 2.0 * np.sin(np.pi / 12.0))
    assert (crest.T_driver, trough.T_driver) == (22.0, -8.0)


@pytest.mark.parametrize("bit", [0, 1, 31, 32, 49, 50, 99, 350, 399])
def test_each_bit_of_a_binary_torque_lasts_for_its_time(bit) -> None:
    word, place = divmod(bit, 50)
    binary = {"bit_amplitude": 3.0, "bit_time": 0.04, f"bits_{word + 1}": 2.0**place}
    times = [round(0.04 * (bit + at), 6) for at in (-0.01, 0.0, 0.99, 1.01)]
    before, first, last, after = [one.T_driver for one in made(times, **binary)]
    assert (first, last) == (3.0, 3.0)
    assert after == (3.0 if bit == 399 else -3.0), "the last one is held"
    assert before == -3.0 or bit == 0


def test_damping_is_to_be_on_from_one_instant_to_the_other() -> None:
    assert all(one.enable for one in made([0.0, 1e3]))
    assert [one.enable for one in made([0.999, 1.0, 1.999, 2.0], enable_from=1.0, enable_until=2.0)] == [0, 1, 1, 0]
