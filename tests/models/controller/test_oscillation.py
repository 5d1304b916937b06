"""The count of half swings: what is one, what explains it, and how much damping it leaves."""

import math

import pytest

from driveline.models.controller import oscillation
from driveline.models.controller.oscillation import AHEAD, LONGEST, SWINGS, SwingState
from driveline.models.controller.supervision import Parameters

P = Parameters(T_max=100.0, swing=0.12, t_forget=0.5, t_relapse=4.0)
T_S = 0.0625
"""An eighth of the time after which a half swing is forgotten."""
PEAK = 12.0


def after(torques: list[float], changes: list[float] | None = None, x: SwingState | None = None) -> SwingState:
    x = SwingState() if x is None else x
    for torque, change in zip(torques, changes or [0.0] * len(torques), strict=True):
        x = oscillation.update(x, torque, change, True, T_S, P)
    return x


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_half_swing_reaches_over_a_torque_on_both_sides(side: float) -> None:
    more = math.nextafter(PEAK, math.inf)
    assert after([side * more, -side * more]).count == 1.0
    assert after([side * PEAK, -side * more]).count == 0.0
    assert after([side * more, -side * PEAK]).count == 0.0


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_half_swing_that_is_far_smaller_than_the_one_before_is_not_counted(side: float) -> None:
    """For that is what damping makes of it; and none is counted twice."""
    enough = P.swing_decay * 40.0
    assert after([side * 40.0, -side * enough]).count == 1.0
    assert after([side * 40.0, -side * math.nextafter(enough, 0.0)]).count == 0.0
    assert after([side * 40.0, -side * 15.0, -side * enough, -side * 90.0]).count == 1.0 - 1.0 / 8.0
    assert after([side * 40.0, -side * 16.0, side * 14.0]).count == 1.0, "14 is enough after 16"


def test_every_change_of_side_is_one() -> None:
    """One that takes several samples, too."""
    assert after([20.0, -20.0, 20.0]).count == 2.0 - 1.0 / 8.0
    assert after([20.0, 0.0, -20.0, -20.0]).count == 1.0 - 1.0 / 8.0
    assert after([20.0, 20.0, 20.0]).count == 0.0


def test_no_more_are_counted_than_are_forgotten_in_some_seconds() -> None:
    assert after([20.0, -20.0] * 20).count == LONGEST


def test_once_there_is_no_damping_half_swings_are_forgotten_slower() -> None:
    none, less = (SwingState(count=count) for count in (SWINGS, SWINGS - 2.0**-20))
    assert after([0.0], x=none).count == SWINGS - T_S / P.t_relapse
    assert after([0.0], x=less).count == less.count - T_S / P.t_forget


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_change_of_the_demand_explains_half_swings(side: float) -> None:
    """By how large it is beside them: one of the torque of a small half swing explains little of a large one."""
    for torque in (20.0, 80.0):
        changes = [0.0, 0.0, side * 0.25 * P.demand_excuse * (torque + PEAK), 0.0]
        assert after([torque, -torque, 0.0, 0.0], changes).count == pytest.approx(1.0 - 0.25 - 2.0 / 8.0)


def test_the_largest_torque_of_a_half_swing_is_that_of_the_sample_too() -> None:
    x = SwingState(peak=20.0, count=1.0)
    assert after([80.0], [0.5 * P.demand_excuse * (80.0 + PEAK)], x).count == pytest.approx(1.0 - 0.5 - 1.0 / 8.0)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_one_half_swing_may_follow_a_change_of_the_demand(side: float) -> None:
    """However large the change, one and no more; and within t_forget."""
    for change in (AHEAD * P.demand_excuse, 10.0 * P.demand_excuse):
        x = after([0.0, 20.0], [0.0, side * change * P.T_max])
        assert x.count == -AHEAD
        assert after([-20.0], x=x).count == pytest.approx(1.0 - AHEAD + 1.0 / 8.0)
        assert after([0.0] * 8, x=x).count == 0.0


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_peak_of_a_half_swing_has_its_sign(side: float) -> None:
    """It is the largest torque since the last change of side; what is too small for a half swing changes nothing."""
    more = math.nextafter(PEAK, math.inf)
    for torques, peak in (
        ([PEAK], 0.0),
        ([more], more),
        ([20.0, 15.0], 20.0),
        ([20.0, 25.0], 25.0),
        ([20.0, 0.0], 20.0),
        ([20.0, -PEAK], 20.0),
        ([20.0, -more], -more),
        ([20.0, -14.0, -13.0], -14.0),
        ([20.0, -14.0, -40.0, 13.0], 13.0),
    ):
        assert after([side * torque for torque in torques]).peak == side * peak


def test_nothing_is_counted_while_there_is_no_damping() -> None:
    x = oscillation.update(after([20.0]), -20.0, 0.0, False, T_S, P)
    assert x == SwingState() == SwingState(peak=0.0, enough=0.0, count=0.0)


@pytest.mark.parametrize(("amplitude", "growth"), [(30.0, 1.0), (13.0, 1.1), (30.0, 0.9)])
def test_an_oscillation_that_stays_takes_the_damping_away_with_its_third_half_swing(
    amplitude: float, growth: float
) -> None:
    """At 8 Hz; `growth`: of a half swing over the one before."""
    half = round(0.0625 / 0.002)
    x, left = SwingState(), []
    for k in range(8 * half):
        torque = amplitude * growth ** (k / half) * math.sin(math.pi * k / half)
        x = oscillation.update(x, torque, 0.0, True, 0.002, P)
        left.append(oscillation.share(x))
    assert left.index(0.0) / half == pytest.approx(3.3, abs=0.3)
    assert set(left[left.index(0.0) :]) == {0.0}


def test_an_oscillation_that_is_damped_is_not_found() -> None:
    half = round(0.0625 / 0.002)
    x = SwingState()
    for k in range(8 * half):
        x = oscillation.update(x, 80.0 * 0.45 ** (k / half) * math.sin(math.pi * k / half), 0.0, True, 0.002, P)
        assert oscillation.share(x) == 1.0


def test_there_is_less_damping_from_one_half_swing_on_and_none_from_two() -> None:
    shares = [oscillation.share(SwingState(count=count)) for count in (-1.0, 1.0, 1.5, 2.0, 5.5)]
    assert shares == [1.0, 1.0, 0.5, 0.0, 0.0]


def test_the_damping_is_less_from_just_above_one_half_swing_on() -> None:
    for count, less in ((-1.0, False), (1.0, False), (math.nextafter(1.0, 2.0), True), (2.0, True), (5.5, True)):
        x = SwingState(count=count)
        assert (oscillation.is_less(x), oscillation.share(x) < 1.0) == (less, less)
