"""The damping law: what it feeds back, washes out, limits, and how it lets the teeth land."""

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from driveline.models import damping_controller
from driveline.models.controller import T_S as SAMPLE
from driveline.models.controller import damping_law as law
from driveline.models.controller.damping_law import LEAST_DISTANCE, LawState
from driveline.models.controller.interfaces import Addition, Motion
from fmublocks.block.declaration import variables
from tests.models.controller.controllers import above, each_side

P = damping_controller.BLOCK.Parameters(
    k_d=2.0, k_gap=0.5, omega_w=2.0, T_pred=0.5, T_pred_land=0.5, t_land=1.0, t_return=0.5, shape_1=0.0, shape_2=0.0
)._replace(
    J_1=0.25, C=4.0, T_gap=18.0, landing_share=0.5, T_impact=16.0, landing_brake=0.0, demand_lead=0.0, omega_slow=2.0
)
"""In the middle of the gap 16 N.m make omega_land 10 rad/s: the teeth may land with 8 rad/s."""
T_S = 0.25
STILL = Motion(omega_1=100.0, omega_2=100.0, phi=0.75, T_gear=40.0, omega=0.0, phi_B=0.25)
"""In contact, nothing twists."""
AFLOAT = STILL._replace(phi=0.0, T_gear=0.0)
"""The teeth between the flanks."""


def twisting(motion: Motion) -> Motion:
    """With the difference of its speeds."""
    return motion._replace(omega=motion.omega_1 - motion.omega_2)


def start(motion: Motion, T_driver: float, p: Any) -> LawState:
    return law.start(twisting(motion), T_driver, p)


def update(
    x: LawState, motion: Motion, expected: Motion, T_driver: float, T_s: float, p: Any
) -> tuple[LawState, Addition]:
    return law.update(x, twisting(motion), twisting(expected), T_driver, T_s, p)


def added(motion: Motion, x: LawState, T_driver: float = 50.0, p: Any = P) -> float:
    """Torque in N.m that is added to the demand when the motion stays."""
    return sum(update(x, motion, motion, T_driver, T_S, p)[1])


def demanded(motions: list[Motion], T_driver: float, p: Any = P) -> list[float]:
    """T_ref in N.m of each sample under a demand that stays."""
    x, torques = start(motions[0], T_driver, p), []
    for motion in motions:
        x, torque = update(x, motion, motion, T_driver, T_S, p)
        torques.append(T_driver + sum(torque))
    return torques


@given(
    omega=st.floats(-1000.0, 1000.0), phi=st.floats(-2.0, 2.0), T_gear=st.floats(-300.0, 300.0), T=st.floats(-50, 50)
)
def test_a_motion_that_stays_is_not_opposed(omega: float, phi: float, T_gear: float, T: float) -> None:
    motion = Motion(omega, omega, phi, T_gear, 0.0, 0.25)
    assert added(motion, start(motion, T, P), T, P._replace(t_land=0.0)) == 0.0


@pytest.mark.parametrize("motion", [STILL, AFLOAT], ids=["in contact", "afloat"])
def test_the_speed_difference_is_opposed(motion: Motion) -> None:
    """By k_d a rad/s, between the flanks too. Without a demand there is no landing."""
    x = start(motion, 2.0, P)
    assert added(motion._replace(omega_1=103.0), x, 2.0) == -2.0 * 3.0
    assert added(motion._replace(omega_2=103.0), x, 2.0) == 2.0 * 3.0


@pytest.mark.parametrize(("slip", "share"), [(0.25, 1.0), (0.5, 1.0), (0.75, 0.75), (1.0, 0.5)])
def test_half_of_the_damping_is_left_where_it_is_clear_that_the_wheels_slip(slip: float, share: float) -> None:
    motion = STILL._replace(omega_1=103.0, slip=slip)
    assert added(motion, start(STILL, 2.0, P), 2.0) == -share * 2.0 * 3.0
    assert (
        update(start(STILL, 2.0, P), motion, motion, 2.0, T_S, P)[1].damping == -2.0 * 3.0
    )  # of which half swings are


@pytest.mark.parametrize(("slip", "share"), [(0.0, 1.0), (0.5, 0.5), (1.0, 0.0)])
def test_a_change_of_the_demand_is_shaped_where_the_wheels_do_not_slip(slip: float, share: float) -> None:
    """By shape_1 of it at first, which a lag of half a sample forgets, and shape_2 of what the next lag still has."""
    p, motion = P._replace(shape_1=0.5, shape_2=-0.25, omega_shape=2.0), STILL._replace(slip=slip)
    x, torques = start(motion, 10.0, p), []
    for _ in range(4):
        x, torque = update(x, motion, motion, 26.0, T_S, p)
        torques.append(torque.landing)
    once, twice = (16.0, 8.0, 4.0, 2.0), (0.0, 8.0, 8.0, 6.0)
    assert torques == [share * (0.5 * a - 0.25 * b) for a, b in zip(once, twice, strict=True)]


@pytest.mark.parametrize("T_pred", [0.0, 0.125, 0.25, 0.5])
def test_what_will_be_when_the_torque_acts_is_opposed(T_pred: float) -> None:
    """T_pred ahead, be it between this sample and the next one, of 0.25 s, or beyond that."""
    p = P._replace(T_pred=T_pred)
    now, expected = STILL._replace(omega_1=101.0), STILL._replace(omega_1=104.0, omega_2=99.0)
    opposed = 2.0 * (1.0 + 4.0 * T_pred * (5.0 - 1.0))
    x, torque = update(start(STILL, 50.0, p), now, expected, 50.0, T_S, p)
    assert torque == (-opposed, 0.0)
    assert x.washout == 0.5 * opposed


def landing_speed(d: float) -> float:
    """In rad/s, at the distance d (rad) from the flank, with a demand of 16 N.m."""
    return math.sqrt(64.0 + 2.0 * 18.0 * max(d, LEAST_DISTANCE) / 0.25)


@pytest.mark.parametrize("T_pred_land", [0.25, 0.5])
@each_side
def test_the_twist_too_is_taken_ahead_for_a_landing(side: float, T_pred_land: float) -> None:
    """Where the teeth will touch by then there is no way left to land."""
    p, x = P._replace(T_pred_land=T_pred_land), start(AFLOAT, 2.0, P)
    for phi, d in ((0.125, 0.125), (0.25, 0.0), (1.0, 0.0)):
        expected = AFLOAT._replace(phi=side * phi * T_S / T_pred_land)
        _, torque = update(x, AFLOAT, expected, side * 16.0, T_S, p)
        assert side * (side * 16.0 + sum(torque)) == pytest.approx(landing_speed(d))


def test_the_washout_forgets_what_stays() -> None:
    """Each sample by the share omega_w T_s of what is left."""
    x, torques = start(STILL, 50.0, P), []
    for _ in range(4):
        turning = STILL._replace(omega_1=108.0)
        x, torque = update(x, turning, turning, 50.0, T_S, P)
        torques.append(torque.damping)
    assert torques == [-16.0, -8.0, -4.0, -2.0]


def test_no_washout_or_return_is_faster_than_a_sample() -> None:
    """So that its share is at most 1, without a limit in the code."""
    declared: dict[str, Any] = {v.name: v.declaration for v in variables(damping_controller.BLOCK.Parameters)}
    assert {declared[name].maximum for name in ("omega_w", "omega_slow", "omega_shape")} == {400.0}
    assert declared["t_return"].minimum == SAMPLE
    assert 400.0 * SAMPLE < 1.0


@each_side
def test_the_damping_is_limited_to_t_add_max_both_ways(side: float) -> None:
    """And the washout goes on by what would be opposed without a limit."""
    for turning, damping in ((29.5, 59.0), (30.0, 60.0), (30.5, 60.0), (1e6, 60.0)):
        motion = STILL._replace(omega_1=100.0 + side * turning)
        x, torque = update(start(STILL, 50.0, P), motion, motion, 50.0, T_S, P._replace(T_add_max=60.0))
        assert torque == (-side * damping, 0.0)
        assert x.washout == side * turning


@pytest.mark.parametrize("omega", [-8.0, 0.0, 3.0, 12.0])
@each_side
def test_between_the_flanks_the_motor_is_led_to_that_of_the_demand(side: float, omega: float) -> None:
    """With k_gap k_d a rad/s; the largest demand that counts is T_impact."""
    motion = AFLOAT._replace(omega_1=100.0 + side * omega)
    for T in (16.0, 64.0):
        assert demanded([motion], side * T) == [pytest.approx(side * min(10.0 - omega, T), rel=1e-5)]


@pytest.mark.parametrize(
    ("omega", "share"), [(-5.0, -1.0 / 3.0), (0.0, 0.0), (5.0, 1.0 / 3.0), (10.0, 0.5), (30.0, 0.75)]
)
@pytest.mark.parametrize("slip", [0.0, 0.25, 0.5])
@each_side
def test_the_braking_of_a_landing_is_commanded_in_advance(side: float, omega: float, share: float, slip: float) -> None:
    """Half of landing_brake T_gap at the speed of the landing, less for a slower motor and where wheels slip."""
    motion, p = AFLOAT._replace(omega_1=100.0 + side * omega, slip=slip), P._replace(landing_brake=0.25)
    expected = min(10.0 - omega - (1.0 - slip) * 4.5 * share, 16.0)
    assert demanded([motion], side * 16.0, p) == [pytest.approx(side * expected, rel=1e-4)]


def test_the_nearer_the_flank_the_slower() -> None:
    """At the flank landing_share T/sqrt(C J_1) is left, before it what T_gap brakes to that."""
    for d in (0.0, 0.1, 0.4):
        motion = AFLOAT._replace(phi=0.25 - max(d, 1e-9))
        assert demanded([motion], 16.0) == [pytest.approx(landing_speed(d))]
        assert demanded([motion._replace(phi=-motion.phi)], -16.0) == [-demanded([motion], 16.0)[0]]


def test_the_motor_is_not_driven_towards_the_flank_with_more_than_the_demand() -> None:
    """Unless it goes the other way: then with what brakes it."""
    assert demanded([AFLOAT._replace(omega_1=97.0)], 4.0) == [4.0]
    assert demanded([AFLOAT._replace(omega_1=93.0)], 4.0) == [7.0]


@each_side
def test_a_demand_that_rises_will_rise_further(side: float) -> None:
    """By demand_lead times what it has risen of late, which is forgotten with omega_slow."""
    p, x = P._replace(demand_lead=2.0), start(AFLOAT, -side * 2.0, P)
    torques = []
    for _ in range(3):
        x, torque = update(x, AFLOAT, AFLOAT, side * 2.5, T_S, p)
        torques.append(side * (side * 2.5 + sum(torque)))
    expected = [min(math.sqrt((0.5 * T) ** 2 + 36.0), T) for T in (2.5 + 9.0, 2.5 + 4.5, 2.5 + 2.25)]
    assert torques == pytest.approx(expected)


def test_a_demand_that_falls_to_zero_is_not_led_through_the_gap_before_it_has_turned() -> None:
    """It may stop there, and then no flank is asked for."""
    p, x = P._replace(demand_lead=1.0), start(AFLOAT, 40.0, P)
    for T_driver in (4.0, 2.0, 0.0, -2.0):
        assert added(AFLOAT, x, T_driver, p) == 0.0
    assert added(AFLOAT, x, -above(2.0), p) == pytest.approx(-8.0)
    assert update(x, AFLOAT, AFLOAT, 20.0, T_S, p)[0].afloat == 0.0
    assert update(x, AFLOAT, AFLOAT, 21.0, T_S, p)[0].afloat == T_S


@pytest.mark.parametrize("T_driver", [0.0, 2.0, -2.0])
def test_without_a_demand_there_is_no_landing(T_driver: float) -> None:
    """T_still is none; a car that stands in its gap waits for the demand of its launch, however long."""
    x = start(AFLOAT, T_driver, P)
    for _ in range(20):
        x, torque = update(x, AFLOAT, AFLOAT, T_driver, T_S, P)
        assert torque == (0.0, 0.0)
    assert x.afloat == 0.0
    assert update(x, AFLOAT, AFLOAT, above(2.0), T_S, P)[0].afloat == T_S
    assert added(AFLOAT, x, -16.0) == -10.0 + 16.0


def test_the_teeth_have_t_land_to_land() -> None:
    """To the nearest number of samples of 0.25 s. Then what was withheld comes back: half of it in a sample."""
    for t_land in (above(above(0.875)), 1.0, 1.125):
        assert demanded([AFLOAT] * 7, 16.0, P._replace(t_land=t_land)) == pytest.approx([10.0] * 5 + [13.0, 14.5])
    assert demanded([AFLOAT] * 6, 16.0, P._replace(t_land=0.875)) == pytest.approx([10.0] * 4 + [13.0, 14.5])
    assert demanded([AFLOAT] * 2, 16.0, P._replace(t_land=0.0)) == [16.0] * 2


def test_wheels_that_slip_leave_less_time_to_land() -> None:
    slips = AFLOAT._replace(slip=0.5), AFLOAT._replace(slip=1.0)
    assert demanded([slips[0]] * 5, 16.0, P._replace(t_land=1.0)) == pytest.approx([10.0] * 3 + [13.0, 14.5])
    assert demanded([slips[1]] * 2, 16.0) == [16.0] * 2


def test_teeth_that_touched_may_land_again() -> None:
    touching = STILL._replace(T_gear=0.0)
    torques = demanded([AFLOAT] * 9 + [touching] + [AFLOAT] * 5, 16.0, P._replace(t_return=T_S))
    assert torques == pytest.approx([10.0] * 5 + [16.0] * 5 + [10.0] * 5)


def test_the_time_afloat_is_counted_no_further_than_needed() -> None:
    x = start(AFLOAT, 16.0, P)
    for _ in range(20):
        x, _ = update(x, AFLOAT, AFLOAT, 16.0, T_S, P)
    assert x.afloat == P.t_land + T_S
