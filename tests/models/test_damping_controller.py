"""The damping controller as it is delivered: no stationary effect, no bump, and the limits that it is said to have."""

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import pytest
from fmutesting.slow import slow
from hypothesis import given, settings
from hypothesis import strategies as st

from docs.studies import monolithic
from driveline.models import damping_controller, two_mass_driveline, validation_vehicle
from driveline.models.controller import T_S
from driveline.models.controller import torque_estimator as estimator
from driveline.models.controller.supervision import FALLBACK, WITH_WHEEL_SPEED, WITHOUT_WHEEL_SPEED, Input, State
from driveline.models.physics.backlash import dead_zone
from fmublocks.block.types import ContinuousBlock
from tests.models.controller.controllers import (
    ABSURD,
    ROLLING,
    any_input,
    bump,
    drive_inputs,
    run,
    run_with_motor,
    shaken,
)

BLOCK = damping_controller.BLOCK
P = BLOCK.Parameters()
DRIVEN = [u._replace(valid=k >= 600) for k, u in enumerate(drive_inputs(2.5))]
T_REF_DRIVEN = run(BLOCK, DRIVEN)[-1].T_ref


def is_held(x: State[Any, Any]) -> bool:
    """Whether the estimate is that of rest, but for what the torque of a sample makes of it."""
    return x.estimator.base == x.estimator.estimate.omega_2 == x.estimator.estimate.T_l == 0.0


@given(inputs=st.lists(any_input, min_size=1, max_size=20))
@settings(max_examples=25)
@pytest.mark.slow
def test_it_recovers_from_whatever_came_in(inputs: list[Input]) -> None:
    """The torque is that of a controller that never saw it; a motor that turned backwards heals in t_turn."""
    x = run(BLOCK, [*inputs, *DRIVEN])[-1]
    assert x.status == WITH_WHEEL_SPEED
    assert x.T_ref == pytest.approx(T_REF_DRIVEN, abs=3.0)


@given(T=st.floats(-120.0, 120.0), omega=st.floats(10.0, 900.0))
@settings(max_examples=5)
def test_a_stationary_torque_is_unchanged(T: float, omega: float) -> None:
    """The signals change in their last digits only, so that they are not frozen."""
    u = ROLLING._replace(T_driver=T, T_mot_est=T, omega_1_meas=omega, omega_2_can=omega)
    inputs = [
        u._replace(omega_1_meas=omega + 1e-6 * (k % 2), T_mot_est=T + 1e-6 * (k % 2), counter=k // 10)
        for k in range(2500)
    ]
    x = run(BLOCK, inputs)[-1]
    assert x.T_ref == pytest.approx(T, abs=0.02)
    assert x.status == WITH_WHEEL_SPEED


def test_the_estimator_changes_its_mode_without_a_bump() -> None:
    inputs = shaken(2.0)
    states = run(BLOCK, [u._replace(valid=not 300 <= k < 600) for k, u in enumerate(inputs)], swing=1.0)
    assert states[299].status == states[-1].status == WITH_WHEEL_SPEED
    assert states[599].status == WITHOUT_WHEEL_SPEED
    assert bump(states) <= 1.1 * bump(run(BLOCK, inputs, swing=1.0))
    assert max(abs(b.estimator.share - a.estimator.share) for a, b in pairwise(states)) <= 1.001 * T_S / P.t_fade


def test_a_torque_that_is_not_demanded_is_found_without_a_bump() -> None:
    """The change per sample is at most that of the damping torque itself and of its fading."""
    always = run_with_motor(BLOCK, shaken(2.0), swing=1.0)
    obeyed = [u._replace(T_mot_est=x.motor.loop.T_mot) for u, x in zip(shaken(2.0), always, strict=False)]
    states = run(BLOCK, [u._replace(T_mot_est=-50.0) if k >= 500 else u for k, u in enumerate(obeyed)], swing=1.0)
    assert states[500 + round(P.t_bad / T_S) + 2].status == states[-1].status == FALLBACK
    assert bump(states) <= bump(always) + max(abs(x.T_damp) for x in always) * T_S / P.t_fade


def test_a_single_bad_sample_changes_nothing_much() -> None:
    good = shaken(0.5)
    for bad in ABSURD:
        states = run(BLOCK, [u._replace(omega_1_meas=bad) if k == 150 else u for k, u in enumerate(good)])
        assert FALLBACK not in {x.status for x in states}
        for a, b in zip(states[151:], run(BLOCK, good)[151:], strict=True):
            assert a.T_ref == pytest.approx(b.T_ref, abs=2.0)


@pytest.mark.parametrize(("t_rest", "t_fade"), [(0.3, 0.1), (0.7, 0.1), (0.1, 0.7), (0.0, 0.3)])
def test_at_rest_the_estimator_is_held_whatever_the_times(t_rest: float, t_fade: float) -> None:
    at_rest = [Input(T_mot_est=1.0)] * round((t_rest + t_fade) / T_S + 2)
    x, p = run(BLOCK, at_rest, t_rest=t_rest, t_fade=t_fade)[-1], P._replace(t_rest=t_rest, t_fade=t_fade)
    y = BLOCK.update(x, at_rest[0], p)
    assert y.estimator._replace(gap=x.estimator.gap) == x.estimator, "each sample begins where the last one began"
    assert is_held(x)


def test_the_estimate_shown_is_that_of_the_instant_at_which_it_appears() -> None:
    """A motor speed and a torque that are as expected leave it as it is."""
    x = run(BLOCK, drive_inputs(0.1))[-1]
    y, e = BLOCK.output(x, ROLLING, P), x.estimator.estimate
    assert (y.phi_hat, y.omega_2_hat) == (e.phi, x.estimator.base + e.omega_2)
    assert y.T_gear_hat == P.C * dead_zone(e.phi, P.phi_B)
    seen = estimator.take_motor_speed(x.estimator, x.estimator.base + e.omega_1, False, T_S, P)
    assert (seen.estimate.phi, seen.estimate.omega_1) == pytest.approx((e.phi, 0.0), abs=1e-12)


# the numbers that it is delivered with


def test_nothing_is_demanded_or_known_until_somebody_says_so() -> None:
    assert Input() == (0.0, 0.0, 0.0, 0.0, False, 0, True, 0, 0, False)
    x = BLOCK.start(Input(), P)
    assert (x.T_ref, x.status) == (0.0, WITHOUT_WHEEL_SPEED)


def test_the_torque_is_limited_to_180_newton_metres() -> None:
    for T_driver, T_ref in ((179.0, 179.0), (181.0, 180.0), (-181.0, -180.0)):
        assert run(BLOCK, [ROLLING._replace(T_driver=T_driver, enable=False)])[-1].T_ref == T_ref


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_damping_takes_and_adds_at_most_60_newton_metres(side: float) -> None:
    wild = [u._replace(omega_1_meas=150.0 + 12.0 * (u.omega_1_meas - 150.0)) for u in shaken(1.0, T_driver=side * 50.0)]
    never_slips = {"slip_drift": 100.0, "slip_load": 4.0}
    added = [x.T_damp for x in run_with_motor(BLOCK, wild, swing=1.0, t_land=0.0, **never_slips)]
    assert (min(added), max(added)) == pytest.approx((-60.0, 60.0), abs=1e-12)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_damping_and_landing_take_at_most_100_newton_metres(side: float) -> None:
    """The motor runs away through the gap: more than 40 N.m for the landing, and 60 for the damping."""
    afloat = ROLLING._replace(T_driver=side * 150.0, T_mot_est=0.0)
    inputs = [afloat._replace(omega_1_meas=150.0 + side * 2.0 * k) for k in range(8)]
    for landing, most in ({}, 100.0), ({"t_land": 0.0}, 60.0):
        assert min(side * x.T_damp for x in run(BLOCK, inputs, k_d=20.0, **landing)) == -most


def test_a_landing_lasts_a_tenth_of_a_second_at_most() -> None:
    """Coasting with the teeth in the middle between the flanks; the damping is too slow to matter."""
    afloat = ROLLING._replace(T_driver=100.0, T_mot_est=0.0)
    inputs = [afloat._replace(omega_1_meas=150.0 + 1e-9 * k) for k in range(100)]
    states = run(BLOCK, inputs, frozen=1000.0, T_max=2000.0, T_pred=0.0, tau=10.0)
    omega_land = math.sqrt((P.landing_share * 100.0) ** 2 / (P.C * P.J_1) + 2.0 * P.T_gap * P.phi_B / P.J_1)
    T_land = P.k_gap * P.k_d * omega_land
    assert T_land < 80.0
    landing = [x for x in states if x.T_ref == pytest.approx(T_land, abs=1e-3)]
    assert len(landing) * T_S == pytest.approx(0.1, abs=2.5 * T_S)
    assert states[-1].T_ref == pytest.approx(100.0, abs=1e-3)


Fault = Callable[[Input, int], Input]
ONSET = 55

LASTING: dict[str, tuple[int, Fault, float]] = {
    "bad motor signals are bridged for 20 ms": (FALLBACK, lambda u, k: u._replace(T_mot_est=math.nan), 0.02),
    "a torque that is not demanded as well": (FALLBACK, lambda u, k: u._replace(T_mot_est=20.0), 0.02),
    "a message is used for 0.1 s": (WITHOUT_WHEEL_SPEED, lambda u, k: u._replace(counter=5), 0.09),
}
"""What leads to which status, and how long after sample ONSET; the message of that sample is 10 ms old."""


@pytest.mark.parametrize(("status", "fault", "time"), LASTING.values(), ids=LASTING)
def test_a_fault_has_its_time(status: int, fault: Fault, time: float) -> None:
    """To a sample: times are sums of sample times, which have rounding."""
    inputs = [fault(u, k) if k >= ONSET else u for k, u in enumerate(drive_inputs(0.5))]
    found = [x.status for x in run(BLOCK, inputs)[ONSET + 1 :]].index(status)
    assert found * T_S == pytest.approx(time, abs=1.5 * T_S)


@pytest.mark.parametrize(("jump", "used"), [(8.0, True), (8.5, False)])
def test_a_speed_that_jumps_by_8_radians_per_second_is_not_used(jump: float, used: bool) -> None:
    x, bad = run(BLOCK, drive_inputs(0.1))[-1], ROLLING._replace(omega_1_meas=150.0 + jump)
    assert (BLOCK.update(x, bad, P).trust.clock == 0.0) == used


@pytest.mark.parametrize(("omega", "used"), [(2999.0, True), (3001.0, False)])
def test_no_motor_turns_faster_than_3000_radians_per_second(omega: float, used: bool) -> None:
    x = BLOCK.start(ROLLING._replace(omega_1_meas=omega, omega_2_can=omega), P)
    assert (x.motor.omega_1 == omega) == (x.status == WITH_WHEEL_SPEED) == used


def time_to_rest(u: Input) -> float:
    """Time in s until the estimator is held, of a car that drove before; inf if it never is."""
    x = BLOCK.start(u, P)._replace(quiet=0.0)
    for k in range(300):
        if is_held(x):
            return k * T_S
        x = BLOCK.update(x, u, P)
    return math.inf


def test_a_car_is_at_rest_below_2_newton_metres_and_3_radians_per_second() -> None:
    """After 0.3 s the damping fades, for 0.1 s."""
    assert time_to_rest(Input(T_driver=1.9, omega_1_meas=2.9)) == pytest.approx(0.4, abs=1.5 * T_S)
    assert time_to_rest(Input(T_driver=2.1, omega_1_meas=2.9)) == math.inf
    assert time_to_rest(Input(T_driver=1.9, omega_1_meas=3.1)) == math.inf


def test_the_damping_is_switched_within_a_tenth_of_a_second() -> None:
    states = run(BLOCK, [u._replace(enable=k < 10) for k, u in enumerate(drive_inputs(0.2))])
    fading = [x.level for x in states if 0.0 < x.level < 1.0]
    assert (len(fading) + 1) * T_S == pytest.approx(0.1, abs=1.5 * T_S)


# what these numbers are for


def step(before: float, after: float) -> monolithic.Signals:
    return lambda k: (before if k * monolithic.INTERVAL < 0.5 else after, 0.0, 0.0)


PLANTS = [two_mass_driveline.BLOCK, validation_vehicle.BLOCK]


@pytest.mark.parametrize("plant", slow(PLANTS, but=[two_mass_driveline.BLOCK]), ids=lambda block: block.name)
@pytest.mark.parametrize(("v_0", "before", "after"), [(4.0, -12.0, 100.0), (14.0, 100.0, -30.0)])
def test_good_signals_stay_good_with_half_of_every_threshold(
    plant: ContinuousBlock, v_0: float, before: float, after: float
) -> None:
    """When the teeth cross the gap and back, with noise and delays, no signal is near to being found bad."""
    names = ("jump", "wheel_deviation", "wheel_jump", "frozen", "t_stale", "omega_max", "t_bad", "t_apart")
    half = {name: 0.5 * getattr(P, name) for name in names}
    parameters = {"plant": {"v_0": v_0, "T_0": before}, "controller": half}
    y = monolithic.run(plant, step(before, after), 1.5, parameters)
    assert set(y["controller.status"]) == {WITH_WHEEL_SPEED}
