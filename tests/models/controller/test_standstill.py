"""Rest: neither demand nor motion, and for how long."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from driveline.models.controller import standstill
from driveline.models.controller.supervision import Parameters
from tests.models.controller.controllers import above

P = Parameters(T_still=2.0, omega_still=3.0, t_rest=1.0, t_fade=0.5)
T_S = 0.25


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_car_is_still_up_to_a_demand_and_a_motor_speed(side: float) -> None:
    assert standstill.is_still(side * 2.0, side * 3.0, P)
    assert not standstill.is_still(side * above(2.0), 0.0, P)
    assert not standstill.is_still(0.0, side * above(3.0), P)


def test_the_time_of_stillness_is_counted_no_further_than_to_rest_that_was_seen() -> None:
    times, quiet = [], 0.0
    for _ in range(14):
        quiet = standstill.quiet_time(quiet, True, T_S, P)
        times.append((quiet, standstill.is_complete(quiet, P), standstill.is_seen(quiet, P)))
    assert [time for time, _, _ in times] == [min(0.25 * (k + 1), 3.0) for k in range(14)]
    assert [[named[k] for named in times].index(True) for k in (1, 2)] == [5, 11]


def test_a_demand_or_motion_ends_rest_at_once() -> None:
    assert standstill.quiet_time(1.5, False, T_S, P) == 0.0


def test_the_damping_fades_out_after_the_time_at_rest() -> None:
    assert [standstill.remaining_damping(quiet, P) for quiet in (0.0, 1.0, 1.125, 1.25, 1.5, 3.0)] == [
        1.0,
        1.0,
        0.75,
        0.5,
        0.0,
        0.0,
    ]
    assert standstill.remaining_damping(above(1.0), P) < 1.0


@given(t_rest=st.floats(0.0, 10.0), t_fade=st.floats(0.002, 5.0))
def test_rest_is_complete_whatever_the_rounding_of_its_times(t_rest: float, t_fade: float) -> None:
    p = P._replace(t_rest=t_rest, t_fade=t_fade)
    quiet = standstill.quiet_time(standstill.longest(p), True, 0.002, p)
    assert standstill.is_complete(quiet, p)
    assert standstill.remaining_damping(quiet, p) == 0.0
    assert standstill.remaining_damping(0.0, p) == 1.0
    assert not standstill.is_complete(0.0, p)
