"""The count of half swings: what is one, what explains it, and how many are too many."""

import math

import pytest

from driveline.models.controller import oscillation_monitor
from driveline.models.controller.oscillation_monitor import AHEAD, EXCUSE, GROWS, MOST, SWING, SwingState
from driveline.models.controller.supervision import Parameters

P = Parameters(T_max=100.0)
T_S = 0.0625
"""An eighth of the time after which a half swing is forgotten."""
PEAK = SWING * P.T_max


def after(torques: list[float], demands: list[float] | None = None) -> SwingState:
    x = oscillation_monitor.start(50.0)
    for torque, T_driver in zip(torques, demands or [50.0] * len(torques), strict=True):
        x = oscillation_monitor.update(x, torque, T_driver, True, T_S, P)
    return x


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_half_swing_reaches_over_a_torque_on_both_sides(side: float) -> None:
    more = math.nextafter(PEAK, math.inf)
    assert after([side * more, -side * more]).count == 1.0
    assert after([side * PEAK, -side * more]).count == 0.0
    assert after([side * more, -side * PEAK]).count == 0.0


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_half_swings_are_as_large_as_the_motor(side: float) -> None:
    small = P._replace(T_max=1.0)
    for torques, count in (((0.2, -0.15, 0.125), 2.0 - 1.0 / 8.0), ((0.2, -0.13), 0.0)):
        x = oscillation_monitor.start(0.5)
        for torque in torques:
            x = oscillation_monitor.update(x, side * torque, 0.5, True, T_S, small)
        assert x.count == count


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_half_swing_that_is_far_smaller_than_the_one_before_is_not_counted(side: float) -> None:
    """For that is what damping makes of it; and none is counted twice."""
    enough = GROWS * 40.0
    assert after([side * 40.0, -side * enough]).count == 1.0
    assert after([side * 40.0, -side * math.nextafter(enough, 0.0)]).count == 0.0
    assert after([side * 40.0, -side * 20.0, -side * enough, -side * 90.0]).count == 1.0 - 1.0 / 8.0
    assert after([side * 40.0, -side * 20.0, side * 14.0]).count == 1.0, "14 is enough after 20"


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_small_damping_torque_is_calm(side: float) -> None:
    assert oscillation_monitor.is_calm(side * 15.0, P)
    assert not oscillation_monitor.is_calm(side * math.nextafter(15.0, math.inf), P)


def test_every_change_of_side_is_one() -> None:
    """One that takes several samples, too."""
    assert after([20.0, -20.0, 20.0]).count == 2.0 - 1.0 / 8.0
    assert after([20.0, 0.0, -20.0, -20.0]).count == 1.0 - 1.0 / 8.0
    assert after([20.0, 20.0, 20.0]).count == 0.0


def test_half_swings_are_forgotten() -> None:
    assert after([20.0, -20.0] + [0.0] * 4).count == 0.5
    assert after([20.0, -20.0] + [0.0] * 20).count == 0.0


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_change_of_the_demand_explains_half_swings(side: float) -> None:
    changed = 50.0 + side * 0.25 * EXCUSE * P.T_max
    counted = after([20.0, -20.0, 0.0, 0.0], [50.0, 50.0, changed, changed]).count
    assert counted == pytest.approx(1.0 - 0.25 - 2.0 / 8.0)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_one_half_swing_may_follow_a_change_of_the_demand(side: float) -> None:
    """However large the change, one and no more; and within half a second."""
    for change in (AHEAD * EXCUSE, 10.0 * EXCUSE):
        changed = 50.0 + side * change * P.T_max
        x = after([0.0, 20.0], [50.0, changed])
        assert x.count == -AHEAD
        x = oscillation_monitor.update(x, -20.0, changed, True, T_S, P)
        assert x.count == pytest.approx(1.0 - AHEAD + 1.0 / 8.0)
    assert after([0.0] * 9, [50.0] + [90.0] * 8).count == pytest.approx(-1.0 / 8.0)
    assert after([0.0] * 10, [50.0] + [90.0] * 9).count == 0.0


def test_nothing_is_counted_while_the_damping_is_faded_out() -> None:
    x = oscillation_monitor.update(after([20.0]), -20.0, 60.0, False, T_S, P)
    assert x == oscillation_monitor.start(60.0)
    assert oscillation_monitor.update(x, 20.0, 60.0, True, T_S, P).count == 0.0


@pytest.mark.parametrize(("amplitude", "growth"), [(30.0, 1.0), (12.0, 1.1), (30.0, 0.9)])
def test_an_oscillation_that_stays_is_found_with_its_fourth_half_swing(amplitude: float, growth: float) -> None:
    """At 8 Hz; `growth`: of a half swing over the one before."""
    half = round(0.0625 / 0.002)
    x, found = oscillation_monitor.start(50.0), []
    for k in range(8 * half):
        torque = amplitude * growth ** (k / half) * math.sin(math.pi * k / half)
        x = oscillation_monitor.update(x, torque, 50.0, True, 0.002, P)
        found.append(oscillation_monitor.feeds(x))
    assert found.index(True) / half == pytest.approx(3.3, abs=0.3)


def test_an_oscillation_that_is_damped_is_not_found() -> None:
    half = round(0.0625 / 0.002)
    x = oscillation_monitor.start(50.0)
    for k in range(8 * half):
        x = oscillation_monitor.update(x, 80.0 * 0.6 ** (k / half) * math.sin(math.pi * k / half), 50.0, True, 0.002, P)
        assert x.count == 0.0


def test_it_feeds_from_a_number_on() -> None:
    x = oscillation_monitor.start(20.0)
    assert x == SwingState(side=0.0, peak=0.0, enough=0.0, count=0.0, T_driver=20.0)
    assert oscillation_monitor.feeds(x._replace(count=MOST))
    assert not oscillation_monitor.feeds(x._replace(count=math.nextafter(MOST, 0.0)))
