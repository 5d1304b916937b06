"""The torque estimator: its model is the drive train, its corrections have the gains, its estimate has bounds."""

import math
from itertools import pairwise

import pytest

from driveline.models import damping_controller
from driveline.models.controller import T_S
from driveline.models.controller import torque_estimator as estimator
from driveline.models.controller.learned_gap import GapState
from driveline.models.controller.torque_estimator import Estimate, EstimatorState
from fmublocks.block.declaration import Real, variables
from tests.models.controller.controllers import ROLLING

BLOCK = damping_controller.BLOCK
P = BLOCK.Parameters()
GAP = GapState(P.phi_B, flank=1.0, innovations=0.0, before=0.0)
IN_CONTACT = Estimate(omega_1=150.0, omega_2=148.0, phi=P.phi_B + 50.0 / P.C, T_l=-3.0)


def estimating(e: Estimate, share: float = 1.0, late: float = 0.0, phi_B: float = P.phi_B) -> EstimatorState:
    """With the speeds of the estimate counted from 0."""
    return EstimatorState(0.0, e, late=late, share=share, drift=0.0, slip=0.0, gap=GAP._replace(phi_B=phi_B))


def estimate(x: EstimatorState) -> Estimate:
    """With its speeds counted from 0."""
    return estimator.counted_from(-x.base, x.estimate)


def rates(e: Estimate, T_mot: float) -> Estimate:
    """The equations of the estimator's model in contact."""
    T_gear = P.C * (e.phi - P.phi_B)
    return Estimate((T_mot - T_gear) / P.J_1, (e.T_l + (1.0 - P.lambda_v) * T_gear) / P.J_2, e.omega_1 - e.omega_2, 0.0)


def advanced(e: Estimate, h: float, dx: Estimate) -> Estimate:
    return Estimate(*(value + h * rate for value, rate in zip(e, dx, strict=True)))


def distance_after(T_s: float, duration: float = 0.03) -> float:
    """Between samples T_s apart and a fine solution by the midpoint rule: rad and, at 10 Hz and so on, rad/s."""
    coarse, fine, steps = IN_CONTACT, IN_CONTACT, 3000
    for _ in range(round(duration / T_s)):
        coarse = estimator.integrated(coarse, 80.0, P.phi_B, T_s, P)
    h = duration / steps
    for _ in range(steps):
        fine = advanced(fine, h, rates(advanced(fine, 0.5 * h, rates(fine, 80.0)), 80.0))
    return math.dist(coarse, fine)


def test_the_model_follows_its_equations_with_order_two() -> None:
    errors = [distance_after(T_s) for T_s in (0.002, 0.001, 0.0005)]
    assert [a / b for a, b in pairwise(errors)] == pytest.approx([4.0, 4.0], rel=0.05)


@pytest.mark.parametrize(("T_mot", "phi"), [(23.48, 0.357), (-23.48, -0.357), (0.0, 0.0)])
def test_it_starts_with_the_motor_torque_in_the_gear(T_mot: float, phi: float) -> None:
    """Against the flank that bears it, and without torque in the middle of the backlash."""
    p = P._replace(C=117.4, phi_B=0.157)
    e = estimate(estimator.start(120.0, T_mot, True, p))
    assert e == (120.0, 120.0, pytest.approx(phi, rel=1e-12), 0.0)
    assert estimator.motion(estimating(e), p).T_gear == pytest.approx(T_mot, rel=1e-12)


def test_the_smallest_torque_bears_on_its_flank() -> None:
    assert estimator.at_rest_with(5e-324, P.phi_B, P).phi == P.phi_B
    assert estimator.at_rest_with(-5e-324, P.phi_B, P).phi == -P.phi_B


def test_it_starts_in_the_mode_of_the_wheel_speed_that_it_has() -> None:
    with_wheel, without = (estimator.start(120.0, 10.0, wheel, P) for wheel in (True, False))
    assert (with_wheel.share, without.share) == (1.0, 0.0)
    assert with_wheel.late == without.late == 120.0


def test_a_new_start_keeps_the_mode_and_the_gap_alone() -> None:
    x = EstimatorState(140.0, IN_CONTACT, late=130.0, share=0.25, drift=1.0, slip=0.5, gap=GAP)
    for wheel in (True, False):
        fresh = estimator.start(90.0, -20.0, wheel, P)
        assert estimator.restart(x, 90.0, -20.0, P) == fresh._replace(share=0.25)


GAINS = P._replace(
    L_omega_1=0.5, L_omega_2=0.25, L_phi=-0.0625, L_T_l=1.0,
    Ls_omega_1=0.25, Ls_omega_2=1.0, Ls_phi=-0.125, Ls_T_l=8.0, slip_drift=100.0, slip_load=4.0,
    L_can_omega_1=0.0625, L_can_omega_2=0.75, L_can_phi=-0.015625, L_can_T_l=4.0,
)  # fmt: skip
"""Gains whose products have no rounding."""
E_0 = Estimate(omega_1=150.0, omega_2=148.0, phi=0.5, T_l=-3.0)


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("error", [4.0, -4.0])
def test_the_motor_speed_corrects_with_the_same_gains_with_and_without_messages(share: float, error: float) -> None:
    """4 rad/s above the estimate or below it; what a message is compared with waits for the end of the sample."""
    x = estimator.take_motor_speed(estimating(E_0, share, late=140.0), 150.0 + error, False, T_S, GAINS)
    assert x.base == 150.0 + error
    corrected = estimating(advanced(E_0, error, Estimate(0.5, 0.25, -0.0625, 1.0)), share, late=140.0)
    assert x._replace(base=0.0, estimate=estimate(x)) == corrected._replace(drift=x.drift)


@pytest.mark.parametrize(("slip", "correction"), [(1.0, (1.0, 4.0, -0.5, 32.0)), (0.5, (1.5, 2.5, -0.375, 18.0))])
def test_while_the_wheels_slip_the_load_may_change_fast(slip: float, correction: tuple[float, ...]) -> None:
    """With the gains for slip, half of them when half of it is forgotten; 4 rad/s above the estimate."""
    x = estimating(E_0)._replace(slip=slip)
    y = estimator.take_motor_speed(x, 154.0, False, T_S, GAINS._replace(t_grip=1e9))
    assert estimate(y) == pytest.approx(advanced(E_0, 1.0, Estimate(*correction)))


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_wheels_slip_where_the_innovations_drift_or_the_load_is_larger_than_any_vehicle_s(side: float) -> None:
    """From a threshold to twice of it."""
    p = P._replace(T_max=100.0, J_1=0.1, slip_drift=0.5, slip_load=0.25)
    for drift, T_l, slip in ((1.0, 25.0, 0.0), (1.5, 0.0, 0.5), (0.0, 37.5, 0.5), (2.0, 0.0, 1.0), (9.0, 400.0, 1.0)):
        assert estimator.slipping(side * drift, side * T_l, T_S, p) == pytest.approx(slip)


def test_slip_is_seen_at_once_and_forgotten_in_t_grip() -> None:
    p, slips = P._replace(t_grip=1.0, t_drift=0.25, slip_drift=0.01, slip_load=4.0), []
    x = estimating(E_0)
    for k in range(5):
        speed = estimator.motion(x, p).omega_1 + (100.0 if k == 0 else 0.0)
        x = estimator.take_motor_speed(x, speed, False, 0.25, p)
        slips.append(x.slip)
    assert slips == [1.0, 0.75, 0.5, 0.25, 0.0]


def test_the_drift_is_the_mean_of_the_recent_innovations() -> None:
    p, drifts = P._replace(t_drift=1.0), []
    x = estimating(E_0)
    for _ in range(3):
        x = estimator.take_motor_speed(x, estimator.motion(x, p).omega_1 + 4.0, False, 0.25, p)
        drifts.append(x.drift)
    assert drifts == pytest.approx([1.0, 1.75, 2.3125])


@pytest.mark.parametrize("base", [-64.0, 0.0, 150.0, 4096.0])
def test_what_the_speeds_are_counted_from_is_of_no_account(base: float) -> None:
    x = estimating(E_0)
    moved = x._replace(base=base, estimate=estimator.counted_from(base, E_0))
    assert estimator.motion(moved, GAINS) == estimator.motion(x, GAINS)
    assert estimator.take_motor_speed(moved, 154.0, False, T_S, GAINS) == estimator.take_motor_speed(
        x, 154.0, False, T_S, GAINS
    )
    later, expected = (estimator.predict(y, 60.0, True, T_S, GAINS) for y in (moved, x))
    assert later.late == expected.late
    assert estimate(later) == pytest.approx(expected.estimate, rel=1e-12)


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_a_message_corrects_as_far_as_the_wheel_speed_is_in_use(share: float) -> None:
    """It is 4 rad/s above what it should tell, or below."""
    x = estimating(E_0, share, late=140.0)
    for error in (4.0, -4.0):
        e = advanced(E_0, error * share, Estimate(0.0625, 0.75, -0.015625, 4.0))
        assert estimator.take_wheel_speed(x, 140.0 + error, T_S, GAINS) == x._replace(estimate=e)


@pytest.mark.parametrize("late", [0, 1, -1])
def test_a_message_as_old_as_assumed_corrects_a_steady_acceleration_by_nothing(late: int) -> None:
    """The lag is as late as a message of that age, 11.5 samples; a sample more or less shows."""
    p, x = P._replace(T_age=0.023), estimating(E_0)
    for k in range(2000):
        x = estimator.predict(x._replace(estimate=E_0._replace(omega_2=0.05 * k)), 0.0, True, T_S, p)
    message = 0.05 * (2000 - 11.5 - late)
    assert message - x.late == pytest.approx(-0.05 * late, abs=1e-9)


def test_no_lag_or_mean_is_faster_than_a_sample() -> None:
    """So that its share of what is new is at most 1, without a limit in the code."""
    declared = {v.name: v.declaration for v in variables(BLOCK.Parameters)}
    for name in ("T_age", "t_drift", "t_grip", "t_fade"):
        declaration = declared[name]
        assert isinstance(declaration, Real)
        assert declaration.minimum == T_S, name


def test_the_gains_fade_from_one_mode_to_the_other() -> None:
    p, shares = P._replace(t_fade=1.0), []
    x = estimating(E_0, share=0.0)
    for wheel in [True] * 5 + [False] * 5:
        x = estimator.predict(x, 0.0, wheel, 0.25, p)
        shares.append(x.share)
    assert shares == [0.25, 0.5, 0.75, 1.0, 1.0, 0.75, 0.5, 0.25, 0.0, 0.0]


ANEW = Estimate(0.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_an_estimate_with_more_twist_than_the_drive_train_can_bear_begins_anew(side: float) -> None:
    """Four times the largest motor torque in the gear: at the measured speed, in the middle of the gap."""
    p = GAINS._replace(T_max=100.0, C=128.0, phi_B=0.25)
    bound = 0.25 + 4.0 * 100.0 / 128.0
    for phi, known in ((bound, True), (math.nextafter(bound, math.inf), False)):
        x = estimating(E_0._replace(phi=side * phi), 0.5, late=140.0, phi_B=0.25)
        y = estimator.take_motor_speed(x, E_0.omega_1, False, T_S, p)
        assert (y.estimate.phi == side * phi) is known
        assert (y == estimator.restart(x, E_0.omega_1, 0.0, p)) is not known
    gap = GAP._replace(phi_B=0.25, flank=0.0)
    assert y == EstimatorState(E_0.omega_1, ANEW, late=E_0.omega_1, share=0.5, drift=0.0, slip=0.0, gap=gap)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_correction_itself_may_lead_beyond_the_bound(side: float) -> None:
    """With 16 times -0.0625 s the twist changes by a radian."""
    p = GAINS._replace(T_max=100.0, C=128.0, phi_B=0.25)
    for margin, known in ((1.125, True), (0.875, False)):
        e = E_0._replace(phi=side * (0.25 + 4.0 * 100.0 / 128.0 - margin))
        x = estimator.take_motor_speed(estimating(e, phi_B=0.25), e.omega_1 - side * 16.0, False, T_S, p)
        assert (x.estimate != ANEW) is known


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_a_twist_that_is_no_number_begins_anew(value: float) -> None:
    assert estimator.take_motor_speed(estimating(E_0._replace(phi=value)), 150.0, False, T_S, P).estimate == ANEW


def test_from_whatever_estimate_a_finite_one_comes() -> None:
    """A speed or a load that runs away twists the drive train beyond what it can bear, and begins anew."""
    for name in Estimate._fields:
        x = estimating(E_0._replace(**{name: 1e6}))
        for _ in range(2000):
            x = estimator.predict(estimator.take_motor_speed(x, 150.0, False, T_S, P), 50.0, True, T_S, P)
        assert estimator.motion(x, P).omega_2 == pytest.approx(150.0, abs=20.0), name
        assert abs(x.estimate.phi) <= P.phi_B + 4.0 * P.T_max / P.C, name


def test_a_gap_that_is_learned_moves_the_twist_and_leaves_the_gear_torque() -> None:
    """At the end of a crossing to the flank that drives, with a motor that was faster than expected."""
    x = estimating(IN_CONTACT)
    x = x._replace(gap=x.gap._replace(flank=-20.0, innovations=9.0))
    wider = estimator.learn(x, 0.5, False, T_S, P)
    assert wider.gap.phi_B > 1.01 * x.gap.phi_B
    assert estimator.motion(wider, P).T_gear == pytest.approx(50.0, rel=1e-9)
    assert estimator.learn(x, 0.5, True, T_S, P).gap.phi_B == x.gap.phi_B


def test_what_is_expected_of_the_next_sample_is_that_of_the_model() -> None:
    """Speeds stay counted from the measured one; what is found out about slip is kept."""
    x = EstimatorState(64.0, IN_CONTACT, late=212.0, share=1.0, drift=1.0, slip=0.5, gap=GAP)
    ahead = estimator.integrated(IN_CONTACT, 60.0, P.phi_B, 0.005, P)
    assert estimator.predict(x, 60.0, True, 0.005, P) == x._replace(estimate=ahead)
    seen = estimator.motion(x._replace(estimate=ahead), P)
    assert seen == (
        64.0 + ahead.omega_1,
        64.0 + ahead.omega_2,
        ahead.phi,
        P.C * (ahead.phi - P.phi_B),
        ahead.omega_1 - ahead.omega_2,
        P.phi_B,
        0.5,
    )


def test_the_estimate_follows_a_perfect_model() -> None:
    """The estimator fed with its own model, started wrong, finds its twist again without wheel speed."""
    true = Estimate(150.0, 150.0, P.phi_B + 60.0 / P.C, -40.0)
    x = BLOCK.start(ROLLING._replace(valid=False), P)
    for k in range(3000):
        T_mot = 50.0 + 20.0 * math.sin(0.02 * k)
        u = ROLLING._replace(omega_1_meas=true.omega_1, T_mot_est=T_mot, valid=False)
        x = BLOCK.update(x, u, P)
        true = estimator.integrated(true, T_mot, P.phi_B, T_S, P)
    assert x.estimator.estimate.phi == pytest.approx(true.phi, abs=0.02)
    assert estimate(x.estimator).omega_2 == pytest.approx(true.omega_2, abs=0.5)
