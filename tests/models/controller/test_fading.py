"""Fading: even, as long as said, and no further than to the end."""

import pytest

from driveline.models.controller.fading import faded

T_S = 0.25


@pytest.mark.parametrize("on", [True, False])
def test_from_one_end_to_the_other_takes_the_time_to_fade(on: bool) -> None:
    level, end = (0.0, 1.0) if on else (1.0, 0.0)
    left = []
    for _ in range(5):
        level = faded(level, on, T_S, 1.0)
        left.append(abs(end - level))
    assert left == [0.75, 0.5, 0.25, 0.0, 0.0]


def test_from_between_the_ends_a_step_is_as_large() -> None:
    assert (faded(0.375, True, T_S, 0.5), faded(0.625, False, T_S, 0.5)) == (0.875, 0.125)
    assert (faded(0.625, True, T_S, 0.5), faded(0.375, False, T_S, 0.5)) == (1.0, 0.0)
