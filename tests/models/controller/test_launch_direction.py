"""The launch direction: which way the motor sets off out of rest, under the torque that it should have."""

import math

import pytest

from driveline.models.controller import launch_direction
from driveline.models.controller.launch_direction import LaunchState
from driveline.models.controller.supervision import Parameters

P = Parameters(J_1=0.25, T_still=0.25)
T_S = 0.25
PUSHED = launch_direction.start()._replace(pushed=True)
FREE = 4.5
"""Of the launch direction, by its number: a test has to fail when it changes."""

each_side = pytest.mark.parametrize("side", [1.0, -1.0])


def after(
    samples: int,
    x: LaunchState | None = None,
    T_mot: float = 0.5,
    T_driver: float | None = None,
    change: float = 0.0,
    resting: bool = False,
    launching: bool = True,
    omega_1: float = 0.0,
    trusted: bool = True,
) -> LaunchState:
    """The state after samples in which the torque gives a free motor T_mot rad/s each, and it turns by `change`."""
    x = PUSHED if x is None else x
    for _ in range(samples):
        demand = T_mot if T_driver is None else T_driver
        x = launch_direction.update(x, demand, T_mot, omega_1, change, resting, launching, trusted, T_S, P)
    return x


@each_side
def test_it_is_looked_at_when_the_torque_has_given_a_free_motor_a_speed(side: float) -> None:
    assert after(8, T_mot=side * 0.5, change=side * 0.5) == LaunchState(
        True, side * 4.0, side * 4.0, 1.0, 17.0, 0.0, False
    )
    assert after(9, T_mot=side * 0.5, change=side * 0.5) == LaunchState(
        True, side * FREE, side * FREE, 1.125, 21.375, 1.0, False
    )
    most = math.nextafter(FREE, 0.0)
    assert after(1, T_mot=side * most, change=-side * 0.5 * most).way == 0.0
    assert after(1, T_mot=side * FREE, change=-side * 0.5 * FREE).way == -1.0


@each_side
@pytest.mark.parametrize(
    ("turned", "way"),
    [
        (2.82, 0.0), (2.8125, 1.0), (1.6875, 1.0), (1.68, 0.0), (0.0, 0.0), (-1.68, 0.0), (-1.6875, -1.0),
        (-2.8125, -1.0), (-2.82, 0.0), (-20.0, 0.0),
    ],
)  # fmt: skip
def test_it_has_turned_with_the_torque_or_against_it_but_for_a_quarter_of_that(
    side: float, turned: float, way: float
) -> None:
    """That is FREE/2 on the way to FREE; on the flank it hardly turns, and a car that rolls back turns it faster."""
    x = after(1, T_mot=side * FREE, change=side * turned)
    assert (x.way, launch_direction.is_with(x), launch_direction.is_against(x)) == (way, way > 0.0, way < 0.0)
    assert launch_direction.heading(x) == side


@each_side
def test_a_motor_that_is_thrown_back_by_a_flank_has_not_set_off_against_the_torque(side: float) -> None:
    """It was on its way with the torque before: at the end it turns as a wrong sign would."""
    x = after(7, T_mot=side * 0.5, change=side * 0.5)
    x = after(2, x, T_mot=side * 0.5, change=-side * 4.0)
    assert (x.turned, x.way) == (-side * FREE, 0.0)


@each_side
def test_a_car_that_rocks_back_and_forth_tells_nothing(side: float) -> None:
    """On ice: too fast against the torque first and too slow then, in the mean as a wrong sign would."""
    x = after(4, T_mot=side * 0.5, change=-side)
    x = after(5, x, T_mot=side * 0.5, change=side * 0.25)
    assert (x.turned, x.way) == (-side * 2.75, 0.0)


def test_it_is_looked_at_once_and_known_until_the_next_rest() -> None:
    x = after(9, change=-0.5)
    assert after(9, x, change=5.0) == x
    assert after(1, x, change=5.0, launching=False) == x
    assert (
        after(1, x, T_driver=0.0, resting=True)
        == launch_direction.start()
        == LaunchState(False, 0.0, 0.0, 0.0, 0.0, 0.0, False)
    )
    assert launch_direction.heading(launch_direction.start()) == 0.0


@each_side
def test_it_is_the_demand_that_ends_the_rest(side: float) -> None:
    """A car that rolls back is thrown about by its drive train, and the damping pushes against that."""
    for T_driver, pushed in ((0.25, False), (math.nextafter(0.25, 1.0), True)):
        x = after(1, launch_direction.start(), T_driver=side * T_driver, resting=True)
        assert x == launch_direction.start()._replace(pushed=pushed)
        assert (after(1, x, T_mot=side * FREE, change=-side * 0.5 * FREE).way < 0.0) == pushed
    assert after(1, PUSHED, T_driver=side * 0.25, resting=True) == launch_direction.start()
    assert (
        after(9, launch_direction.start(), T_driver=side * 50.0, T_mot=side * 2.0, change=-side)
        == launch_direction.start()
    )


@each_side
def test_torque_beyond_the_demand_or_against_it_does_not_count(side: float) -> None:
    assert after(1, T_driver=side * 0.25, T_mot=side * 2.0).free == side * 0.25
    assert after(1, T_driver=side * 0.25, T_mot=-side * 2.0).free == 0.0


@each_side
def test_a_torque_that_may_be_an_offset_says_nothing(side: float) -> None:
    x = PUSHED._replace(free=side * 4.25, turned=-side * 4.25, off_with=18.0)
    assert after(1, x, T_mot=side * 0.375, change=-side * 0.25).way == -1.0
    assert after(9, x._replace(free=side * 4.4), T_mot=side * 0.374, change=-side * 0.25).way == 0.0


def test_only_a_car_that_was_at_rest_a_moment_ago_departs() -> None:
    x = after(2, change=-0.5)
    assert after(9, x, change=-0.5, launching=False) == x
    assert after(7, x, change=-0.5).way == -1.0


@each_side
def test_a_speed_that_was_bad_misleads_while_it_is_not_where_the_motor_has_set_off_to(side: float) -> None:
    """During the launch, and from where on a motor turns backwards."""
    x = after(1, T_mot=side * FREE, change=side * 0.5 * FREE)
    opposite = -side * math.nextafter(P.omega_still, math.inf)
    assert after(1, x, omega_1=opposite, trusted=False).wrong_sign
    assert not after(1, x, omega_1=-side * P.omega_still, trusted=False).wrong_sign
    assert not after(1, x, omega_1=-opposite, trusted=False).wrong_sign
    assert not after(1, x, omega_1=opposite, trusted=True).wrong_sign, "a motor may be thrown back, and a car roll"
    assert not after(1, x, omega_1=opposite, trusted=False, launching=False).wrong_sign
    for way in (-1.0, 0.0):
        assert not after(1, x._replace(way=way), omega_1=opposite, trusted=False).wrong_sign


@each_side
def test_a_right_sign_is_forgotten_with_the_first_fault_after_the_launch(side: float) -> None:
    x = after(1, T_mot=side * FREE, change=side * 0.5 * FREE)
    for launching, trusted, way in ((False, True, 1.0), (True, False, 1.0), (False, False, 0.0)):
        assert after(1, x, launching=launching, trusted=trusted).way == way
    wrong = after(1, T_mot=side * FREE, change=-side * 0.5 * FREE)
    assert after(1, wrong, launching=False, trusted=False).way == -1.0
