"""Fading: even, as long as said, and no further than the target."""

from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from driveline.models.controller.fading import toward

P = SimpleNamespace(t_fade=1.0)
T_S = 0.25


@pytest.mark.parametrize(("value", "target"), [(0.0, 1.0), (1.0, 0.0)])
def test_from_one_end_to_the_other_takes_the_time_to_fade(value: float, target: float) -> None:
    values = []
    for _ in range(5):
        value = toward(value, target, T_S, P.t_fade)
        values.append(abs(target - value))
    assert values == [0.75, 0.5, 0.25, 0.0, 0.0]


@given(value=st.floats(0.0, 1.0), target=st.floats(0.0, 1.0), t_fade=st.floats(0.002, 5.0))
def test_the_target_is_never_passed(value: float, target: float, t_fade: float) -> None:
    nearer = toward(value, target, 0.002, t_fade)
    assert min(value, target) - 1e-15 <= nearer <= max(value, target) + 1e-15
