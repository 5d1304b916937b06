"""A motor that sets off against its torque: found just like one that does, and nothing else."""

import math

import pytest

from driveline.models.controller import launch
from driveline.models.controller.launch import LaunchState
from driveline.models.controller.supervision import Parameters

P = Parameters(T_max=1.0, J_1=0.25, T_still=0.25, free=4.5)
T_S = 0.25
FREE = 4.5
"""Speed in rad/s of the free motor at which is looked; T_max adds 1 rad/s in such a sample."""
AT_REST = LaunchState(free=0.0, off=0.0)

each_side = pytest.mark.parametrize("side", [1.0, -1.0])


def after(
    speeds: list[float],
    x: LaunchState = AT_REST,
    T_mot: float = 0.5,
    T_driver: float | None = None,
    resting: bool = False,
) -> tuple[LaunchState, list[bool]]:
    """The state after samples with these motor speeds, and in which the motor has set off against its torque."""
    found = []
    for omega_1 in speeds:
        demand = T_mot if T_driver is None else T_driver
        x, against = launch.update(x, demand, T_mot, omega_1, resting, T_S, P)
        found.append(against)
    return x, found


def against(side: float) -> list[float]:
    """Speeds of a motor that sets off against a torque of 0.5 N.m, in the middle of each sample."""
    return [-side * 0.5 * (k + 0.5) for k in range(9)]


@each_side
def test_a_motor_sets_off_against_its_torque_as_a_free_one_with_it(side: float) -> None:
    """It is looked at when the torque has given a free motor a speed."""
    x, found = after(against(side), T_mot=side * 0.5)
    assert found == [False] * 8 + [True]
    assert x == LaunchState(free=side * FREE, off=0.0)
    assert not any(after(against(-side), T_mot=side * 0.5)[1])


@each_side
@pytest.mark.parametrize(("off", "found"), [(0.5625, True), (0.563, False), (-0.5625, True), (-0.563, False)])
def test_it_may_be_off_by_a_quarter_of_that_in_the_mean(side: float, off: float, found: bool) -> None:
    speeds = [speed + side * off for speed in against(side)]
    assert after(speeds, T_mot=side * 0.5)[1][-1] is found


@each_side
def test_a_motor_that_is_thrown_back_or_rocks_on_ice_tells_nothing(side: float) -> None:
    """At the end it turns as a wrong sign would."""
    assert not any(after([*against(-side)[:7], *against(side)[7:]], T_mot=side * 0.5)[1])
    assert not any(after([-side * (1.0 + k) for k in range(4)] + [-side * 4.0] * 5, T_mot=side * 0.5)[1])


def test_it_is_looked_at_once_after_each_rest() -> None:
    x, _ = after(against(1.0))
    assert not any(after(against(1.0), x)[1])
    x, _ = after([0.0], x, T_driver=0.3, resting=True)
    assert x == AT_REST
    assert after(against(1.0), x)[1][-1]
    assert not any(after(against(1.0), launch.start(T_S, P))[1]), "nor at the start of a car that drives"


@each_side
def test_it_is_the_demand_that_ends_the_rest(side: float) -> None:
    """A car that rolls back is thrown about by its drive train."""
    for T_driver, looked_at in ((0.25, False), (math.nextafter(0.25, 1.0), True)):
        x, _ = after([0.0], T_driver=side * T_driver)
        assert any(after(against(side), x, T_mot=side * 0.5)[1]) is looked_at


@each_side
def test_torque_against_the_demand_does_not_count(side: float) -> None:
    assert after([0.0], T_driver=side * 0.5, T_mot=side * 2.0)[0].free == side * 2.0
    assert after([0.0], T_driver=side * 0.5, T_mot=-side * 2.0)[0].free == 0.0
