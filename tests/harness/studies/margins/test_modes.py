"""The modes of the linear loop are those of its parts, and damped where the loop is closed."""

from math import pi, sqrt

import numpy as np
import pytest

from driveline.harness.design.design import design, gains_of
from driveline.harness.design.design_weights import MOTOR, PLANT, records
from driveline.harness.design.loop_parameters import loop_parameters
from driveline.harness.studies.margins.linear_loop import linear_loop
from driveline.harness.studies.margins.loop_analysis import point_of
from driveline.harness.studies.margins.modes import alone, drive_train_mode, modes
from driveline.harness.studies.margins.operating_point import Point
from driveline.models import validation_vehicle
from tests.harness.studies.margins.contact import rigid, swing

SECOND_CAR = {"J_1": 0.09, "J_2": 0.45, "C": 210.0, "phi_B": 0.06, "i": 10.5, "m": 2200.0, "r": 0.34}


@pytest.mark.parametrize(
    "car", [{}, SECOND_CAR, {"phi_B": 0.0}, {"C": 58.7, "m": 900.0}, {"phi_B": 0.314, "m": 3500.0}]
)
def test_the_loop_is_stable_in_contact_and_swings_less_than_without_damping(car: dict[str, float]) -> None:
    plant, motor, can = records(car)
    gains = gains_of(plant, motor, can)
    poles = np.abs(np.linalg.eigvals(rigid(plant, motor, gains).closed()))
    assert np.sort(poles)[-2] < 1.0, "all but one,"
    assert poles.max() == pytest.approx(1.0), "the speed of the car"
    alone, damped = swing(plant, motor, gains)
    assert alone.damping_ratio == pytest.approx(0.0, abs=1e-6)
    assert damped.damping_ratio > 0.4


def test_without_feedback_the_loop_has_the_modes_of_its_parts() -> None:
    found = modes(rigid(PLANT, MOTOR, design()), gain=0.0)
    wheels = PLANT.J_2 + PLANT.m * PLANT.r**2 / PLANT.i**2
    omega_0 = sqrt(PLANT.C * (1.0 / PLANT.J_1 + 1.0 / wheels))
    expected = [(omega_0 / (2.0 * pi), 0.0), (1.0 / (2.0 * pi * MOTOR.tau), sqrt(0.5))]
    for frequency, damping_ratio in expected:
        near = min(found, key=lambda mode: abs(mode.frequency - frequency))
        assert near == pytest.approx((frequency, damping_ratio), abs=1e-6)


@pytest.mark.parametrize(
    ("kmh", "design_model", "vehicle"),
    [(15.0, (7.43, 0.033), (7.99, 0.066)), (50.0, (7.81, 0.041), (8.04, 0.174)), (100.0, (7.94, 0.025), (8.28, 0.336))],
)
def test_the_undamped_drive_train_swings_as_the_reference_study_says(kmh, design_model, vehicle) -> None:
    for point, expected in ((Point(), design_model), (Point(plant=validation_vehicle.BLOCK), vehicle)):
        at_speed = Point(plant=point.plant, v=kmh / 3.6, wheel=False)
        found = modes(linear_loop(at_speed), gain=0.0)
        mode = min(found, key=lambda mode: abs(mode.frequency - expected[0]))
        assert mode == pytest.approx(expected, rel=0.02)


def test_the_drive_train_with_control_is_the_mode_that_its_motor_moves() -> None:
    """In this car another mode is less damped, and hardly moved: 13.1 Hz, .10."""
    car = {
        "m": 2639.17,
        "r": 0.281511,
        "i": 13.3771,
        "J_1": 0.0352914,
        "J_2": 0.26171,
        "C": 52.0527,
        "phi_B": 0.3886,
        "c_slip": 271674.0,
        "T_max": 130.69,
    }
    point = point_of(
        "ValidationVehicle", "DampingController", loop_parameters({**car, **design(car)}, "ValidationVehicle")
    )
    found = drive_train_mode(linear_loop(point), alone(point).frequency)
    assert found.frequency == pytest.approx(8.1, rel=0.02)
    assert found.damping_ratio == pytest.approx(0.52, rel=0.05)
    about = [each for each in modes(linear_loop(point).mean) if 0.5 < each.frequency / 6.66 < 2.0]
    assert min(each.damping_ratio for each in about) < 0.15
