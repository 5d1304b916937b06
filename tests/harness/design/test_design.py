"""The stored gains are those of the design, and the design is what it says of itself."""

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest
from scipy.linalg import solve_discrete_are

from driveline.fmus.errors import ParameterFileError
from driveline.harness.design.character import FACTORS
from driveline.harness.design.design import AUTHORITY, design, gains_of, literal_observer
from driveline.harness.design.design_weights import CAN, MOTOR, PLANT, WEIGHTS, drive_train, records
from driveline.harness.design.kalman import (
    DesignError,
    message_gains,
    motor_speed_gains,
    process_noise,
    speed_noise,
    transition,
)
from driveline.models.controller import T_S
from driveline.models.damping_controller import BLOCK
from tests.harness.studies.margins.contact import swing

STORED_DIGITS = 1e-5
"""Six digits are stored."""

SECOND_CAR = {"J_1": 0.09, "J_2": 0.45, "C": 210.0, "phi_B": 0.06, "i": 10.5, "m": 2200.0, "r": 0.34}


def test_the_gains_of_the_paper_s_observer_are_stationary_for_its_model() -> None:
    """The covariance that they leave does not change over a sample, in which the third state feels no load."""
    gains = literal_observer()
    L = np.array([gains[f"L_{state}"] for state in ("omega_1", "omega_2", "phi")])
    train = drive_train(PLANT, MOTOR, CAN)
    A, Q = transition(PLANT, 0.0)[:3, :3], process_noise(PLANT, MOTOR, train, WEIGHTS)[:3, :3]
    P = np.eye(3)
    for _ in range(4000):
        P = A @ P @ A.T + Q
        K = P[:, 0] / (P[0, 0] + speed_noise(MOTOR))
        P = P - np.outer(K, P[0])
    assert pytest.approx(L, rel=1e-6) == K


@pytest.mark.parametrize("T_age", [T_S, 2.0 * T_S, 0.023])
def test_a_message_in_every_sample_is_a_measurement_of_the_speed_behind_a_lag(T_age: float) -> None:
    """Then the gains are those of the stationary filter with both measurements, for the state with the lag."""
    train = drive_train(PLANT, MOTOR, CAN)
    A, Q = transition(PLANT, train.lambda_v), process_noise(PLANT, MOTOR, train, WEIGHTS)
    F, noise, H, R = np.zeros((5, 5)), np.zeros((5, 5)), np.eye(5)[[0, 4]], np.diag([speed_noise(MOTOR), 0.25])
    F[:4, :4], noise[:4, :4] = A, Q
    F[4] = [0.0, T_S / T_age, 0.0, 0.0, 1.0 - T_S / T_age]
    P = solve_discrete_are(F.T, H.T, noise, R)
    K = P @ H.T @ np.linalg.inv(H @ P @ H.T + R)
    assert message_gains(A, Q, R[0, 0], R[1, 1], T_age, cycle=1) == pytest.approx(K[:4, 1], rel=1e-6)


@pytest.mark.parametrize("cycle", [1, 10])
def test_the_rarer_a_message_the_more_it_tells(cycle: int) -> None:
    """Of a speed that is a random walk, told with the age of a sample: the variance before a message is known."""
    q, R = 0.5, 2.0
    walked = cycle * q
    m = 0.5 * (walked + sqrt(walked * walked + 4.0 * walked * R))
    found = message_gains(np.eye(2), q * np.eye(2), 1.0, R, T_S, cycle)
    assert found == pytest.approx([0.0, m / (m + R)])


def test_the_controller_has_the_gains_and_the_model_of_the_design() -> None:
    defaults = BLOCK.Parameters()._asdict()
    for name, value in design().items():
        assert defaults[name] == pytest.approx(value, rel=STORED_DIGITS), name
    p = BLOCK.Parameters()
    assert (p.J_1, p.J_2, p.C, p.phi_B) == (PLANT.J_1, PLANT.J_2, PLANT.C, PLANT.phi_B)


def test_a_car_is_the_default_car_where_its_file_says_nothing() -> None:
    plant, motor, can = records({"J_1": 0.09, "tau": 0.004, "d_max": 0.03, "d_s": 30.0})
    assert plant == PLANT._replace(J_1=0.09)
    assert motor == MOTOR._replace(tau=0.004)
    assert can == CAN._replace(d_max=0.03)


@pytest.mark.parametrize("scale", [0.4, 2.5])
def test_a_car_of_another_size_gets_the_same_gains_in_its_own_units(scale: float) -> None:
    """All inertias, stiffness and torques larger by one factor: the same motions, torques larger by that factor."""
    plant = PLANT._replace(J_1=scale * PLANT.J_1, J_2=scale * PLANT.J_2, C=scale * PLANT.C, m=scale * PLANT.m)
    gains, default = gains_of(plant, MOTOR._replace(T_max=scale * MOTOR.T_max)), design()
    with_torque = {"k_d", "T_gap", "T_impact", *AUTHORITY, *(f"{L}_T_l" for L in ("L", "Ls", "L_can"))}
    for name, value in gains.items():
        assert value == pytest.approx(default[name] * (scale if name in with_torque else 1.0), rel=STORED_DIGITS), name


def test_the_vehicle_takes_its_share_of_the_gear_torque_as_far_as_the_controller_allows() -> None:
    # With a wheel share of 1 the estimated wheels move as one with the vehicle.
    train = drive_train(PLANT, MOTOR, CAN, replace(WEIGHTS, wheel_share=1.0))
    assert train.M == pytest.approx(1450.0 * 0.29**2 / 9.0**2)
    assert (1.0 - train.lambda_v) / PLANT.J_2 == pytest.approx(1.0 / (PLANT.J_2 + train.M))
    assert train.omega_0 / (2.0 * pi) == pytest.approx(swing(PLANT, MOTOR, design())[0].frequency, rel=1e-6)
    physical = PLANT._replace(J_2=1.9 / 81.0)
    assert drive_train(physical, MOTOR, CAN).lambda_v == 0.99
    assert swing(physical, MOTOR, gains_of(physical))[1].damping_ratio > 0.4


def test_a_faster_drive_train_keeps_its_damping_ratio_and_a_slower_one_uses_up_the_phase() -> None:
    stiff, soft = gains_of(PLANT._replace(C=2.0 * PLANT.C)), gains_of(PLANT._replace(C=0.5 * PLANT.C))
    default, slow_motor = design(), gains_of(PLANT._replace(C=0.5 * PLANT.C), MOTOR._replace(tau=2.0 * MOTOR.tau))
    assert stiff["k_d"] == pytest.approx(default["k_d"] * sqrt(2.0), rel=STORED_DIGITS)
    train = drive_train(PLANT, MOTOR, CAN)
    assert soft["k_d"] == pytest.approx(WEIGHTS.phase * PLANT.J_1 / train.T_dead, rel=STORED_DIGITS)
    assert slow_motor["k_d"] == pytest.approx(default["k_d"] * sqrt(0.5), rel=STORED_DIGITS), "the ratio asks for more"


@pytest.mark.parametrize(
    ("name", "power", "just", "beyond", "most"),
    [("T_pred", 2, 0.0205, 0.021, 0.02), ("T_pred_land", 1, 0.029, 0.031, 0.05)],
)
def test_a_slower_motor_is_looked_ahead_further_as_far_as_the_controller_can(name, power, just, beyond, most) -> None:
    """As the square of the dead time, of which 3 ms are not the motor's; for a landing as that time."""

    def ahead(tau: float) -> float:
        return gains_of(motor=MOTOR._replace(tau=tau))[name]

    dead = [0.003 + sqrt(2.0) * tau for tau in (0.003, 0.006)]
    assert ahead(0.006) / ahead(0.003) == pytest.approx((dead[1] / dead[0]) ** power)
    assert ahead(just) < ahead(beyond) == most


def test_a_softer_or_harder_car_has_another_character() -> None:
    """In the middle the gains are as designed; at both ends the factors are whole, half way their roots."""
    middle, sport, soft, comfort = (design(character=character) for character in (0.5, 0.0, 0.75, 1.0))
    for name, (least, most) in FACTORS.items():
        for found, factor in ((sport, least), (soft, sqrt(most)), (comfort, most)):
            assert found[name] == pytest.approx(factor * middle[name])
    assert {name for name, value in sport.items() if value != middle[name]} == set(FACTORS)


def test_a_stiffer_drive_train_is_given_back_its_torque_sooner() -> None:
    """Washout, lead and return follow its frequencies, of which one is the motor's with it and one the vehicle's.

    As far as the controller can: it gives nothing back sooner than in a sample.
    """
    twice, stiff, default = (gains_of(PLANT._replace(C=factor * PLANT.C)) for factor in (2.0, 4.0, 1.0))
    assert stiff["omega_w"] == pytest.approx(2.0 * default["omega_w"], rel=STORED_DIGITS)
    assert stiff["omega_slow"] == pytest.approx(2.0 * default["omega_slow"], rel=STORED_DIGITS)
    assert twice["t_return"] == pytest.approx(sqrt(0.5) * default["t_return"], rel=STORED_DIGITS)
    assert gains_of(PLANT._replace(C=8.0 * PLANT.C))["t_return"] == T_S > sqrt(1.0 / 8.0) * default["t_return"]
    assert stiff["t_land"] == pytest.approx(0.5 * default["t_land"], rel=STORED_DIGITS)


def test_a_landing_is_made_for_a_share_of_what_the_motor_can_unless_it_begins_too_fast() -> None:
    def begins(T: float, phi_B: float) -> float:
        return sqrt(4.0 * PLANT.C * phi_B * T)

    narrow, wide = 0.5 * PLANT.phi_B, 2.0 * PLANT.phi_B
    soft, hard = (gains_of(PLANT._replace(phi_B=gap))["T_gap"] for gap in (narrow, wide))
    assert soft == pytest.approx(WEIGHTS.landing * MOTOR.T_max)
    assert begins(soft, narrow) < WEIGHTS.impact * MOTOR.T_max
    assert begins(hard, wide) == pytest.approx(WEIGHTS.impact * MOTOR.T_max)
    assert hard < WEIGHTS.landing * MOTOR.T_max


def test_the_control_may_take_and_add_shares_of_what_the_motor_can_and_more_for_a_wide_gap() -> None:
    for T_max in (150.0, MOTOR.T_max, 500.0):
        gains = gains_of(PLANT._replace(phi_B=0.5 * PLANT.phi_B), MOTOR._replace(T_max=T_max))
        assert gains["T_take_max"] == pytest.approx(T_max * 100.0 / 180.0)
        assert gains["T_add_max"] == pytest.approx(T_max * 60.0 / 180.0)
    # The torque of an impact without landing grows with the root of the gap; the default gap is just not wide.
    default, wide = design(), gains_of(PLANT._replace(phi_B=4.0 * PLANT.phi_B))
    assert wide["T_take_max"] == pytest.approx(2.0 * default["T_take_max"], rel=1e-3)
    assert wide["T_add_max"] == default["T_add_max"]
    assert gains_of(PLANT._replace(phi_B=1.001 * PLANT.phi_B))["T_take_max"] > default["T_take_max"]


@pytest.mark.parametrize("name", AUTHORITY)
def test_a_limit_that_a_user_sets_stays_a_limit(name: str) -> None:
    asked = design()[name]
    assert design(limits={name: 0.999 * asked})[name] == 0.999 * asked
    assert design(limits={name: 1.001 * asked})[name] == asked


def test_an_older_message_corrects_less_and_a_larger_damping_ratio_damps_more() -> None:
    late = CAN._replace(d_min=0.02, d_max=0.04)
    assert gains_of(can=late)["T_age"] == pytest.approx(design()["T_age"] + 0.017)
    assert 0.0 < gains_of(can=late)["L_can_omega_2"] < design()["L_can_omega_2"]
    ratios = [0.5, 0.6, 0.7]
    found = [swing(PLANT, MOTOR, design(weights=replace(WEIGHTS, damping_ratio=ratio)))[1] for ratio in ratios]
    assert [mode.damping_ratio for mode in found] == sorted(mode.damping_ratio for mode in found)


def test_the_load_torque_is_a_random_walk_and_a_filter_that_does_not_exist_shows_its_matrices() -> None:
    A = transition(PLANT, 0.9)
    assert A[3].tolist() == [0.0, 0.0, 0.0, 1.0]
    assert np.all(np.linalg.eigvalsh(process_noise(PLANT, MOTOR, drive_train(PLANT, MOTOR, CAN), WEIGHTS)) > 0.0)
    with pytest.raises(DesignError, match=r"(?s)no stationary Kalman filter.*A =\n\[\[2\."):
        motor_speed_gains(2.0 * np.eye(4), np.zeros((4, 4)), 1.0)


@pytest.mark.parametrize(
    ("car", "error", "message"),
    [
        ({"T_cyc": 0.2}, DesignError, r"T_age would be 0\.113; the controller takes 0\.002 to 0\.1 s"),
        ({"J_1": 10.0}, DesignError, r"k_d would be .*; the controller takes 0 to 200 N\.m\.s/rad"),
        ({"sigma_omega": 0.0, "q_omega": 0.0}, DesignError, "a motor speed without error leaves nothing to estimate"),
        ({"mm": 1.0, "J1": 0.1}, ParameterFileError, r"mm is not known; did you mean m\?\nJ1 is .*; did you mean J_1"),
        (3, ParameterFileError, "the car 3 must be the entries of a vehicle file"),
    ],
)
def test_what_the_controller_cannot_be_set_to_and_what_no_vehicle_has_is_said(car, error, message) -> None:
    with pytest.raises(error, match=message):
        design(car)
