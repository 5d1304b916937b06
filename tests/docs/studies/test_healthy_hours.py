"""Healthy hours: what they drive, and that they would tell of a false alarm and of how near one was."""

from functools import partial

import numpy as np
import pytest

from docs.studies import healthy_hours
from docs.studies.healthy_hours import (
    HARSH_BRAKE,
    HARSH_TORQUE,
    MINUTE,
    ROADS,
    Found,
    contradiction,
    disobeyed,
    drive,
    residuals_on,
    worst,
)
from driveline.harness.simulation.simulate import simulate
from driveline.models.controller import T_S
from driveline.models.physics.vehicle import added_speed

P = healthy_hours.P
FAR = P.wheel_deviation * added_speed(P, T_S) + P.g_radius * 150.0
"""How far the motor may be from wheels with 150 rad/s."""


def rows_of(**columns: object) -> np.ndarray:
    """100 samples of a car that rolls with 150 rad/s, with other columns where given; a message in every sample."""
    usual = {"motor.omega_1_meas": 150.0, "motor.T_mot_est": 0.0, "can.omega_2_can": 150.0, "can.valid": True}
    usual |= {"can.counter": np.arange(100.0), "controller.omega_2_hat": 150.0}
    usual |= {"controller.T_driver": 50.0, "controller.T_ref": 50.0}
    usual |= {name.replace("__", "."): values for name, values in columns.items()}
    rows = np.zeros(100, [(name, bool if name == "can.valid" else float) for name in usual])
    for name, values in usual.items():
        rows[name] = values
    return rows


def mismatch(distance: float, samples: int) -> np.ndarray:
    """The motor is that far from the wheels in the first samples."""
    return np.where(np.arange(100) < samples, 150.0 + distance, 150.0)


def drive_inputs(road, seed: int, every: float = 0.5) -> np.ndarray:
    """T_driver and T_brake (N.m) of a drive, one row each."""
    manoeuvre, _ = drive(road, seed)
    t = np.arange(0.0, MINUTE, every)
    return np.array([manoeuvre.T_driver(t), manoeuvre.T_brake(t)])


@pytest.mark.parametrize("road", ROADS.values(), ids=ROADS)
def test_drives_stand_and_roll_and_brake_with_sensors_within_the_specification(road):
    assert not np.array_equal(drive_inputs(road, 1), drive_inputs(road, 2))
    assert drive(road, 1)[1] == drive(road, 1)[1] != drive(road, 2)[1]
    drives = [drive(road, seed) for seed in range(1, 41)]
    assert {manoeuvre.duration for manoeuvre, _ in drives} == {MINUTE}
    speeds = [manoeuvre.v_0 for manoeuvre, _ in drives]
    assert min(speeds) == 0.0
    assert max(speeds) > 30.0
    T_driver, T_brake = np.hstack([drive_inputs(road, seed) for seed in range(1, 41)])
    assert T_driver.min() < 0.0 < T_driver.max() <= max(road.T_driver, HARSH_TORQUE)
    assert 0.5 * road.T_brake < T_brake.max() <= HARSH_BRAKE
    for name, low, high in (("can.g_w2", 0.98, 1.02), ("motor.g_T", 0.95, 1.05), ("motor.o_T", -1.5, 1.5)):
        assert all(low <= errors[name] <= high for _, errors in drives)
    assert {errors["can.loss"] for _, errors in drives} == {0.0, 0.1}


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_motor_as_far_from_the_wheels_as_it_may_be_is_not_contradicted(side):
    assert contradiction(rows_of(motor__omega_1_meas=mismatch(0.999 * side * FAR, 100))) == 0.0
    assert contradiction(rows_of(motor__omega_1_meas=mismatch(1.001 * side * FAR, 100))) > P.t_apart


def test_a_contradiction_lasts_as_long_as_the_monitor_says_and_disobedience_a_sample():
    # A motor speed that has jumped is still compared with what it was.
    assert contradiction(rows_of(motor__omega_1_meas=mismatch(1.001 * FAR, 20))) == pytest.approx(20 * T_S)
    assert not disobeyed(rows_of(motor__T_mot_est=50.0)).any()
    other = np.where(np.arange(100) == 7, -50.0, 50.0)
    assert np.flatnonzero(disobeyed(rows_of(motor__T_mot_est=other))).tolist() == [7]


@pytest.mark.parametrize("columns", [{"can__valid": False}, {"can__omega_2_can": P.omega_still}, {"can__counter": 0.0}])
def test_wheels_that_say_no_speed_or_stay_silent_contradict_nothing_for_long(columns):
    of = contradiction(rows_of(motor__omega_1_meas=mismatch(2.0 * FAR, 100), **columns))
    assert of <= P.t_stale


@pytest.fixture
def short(native, monkeypatch):
    """Drives of three seconds, on freshly built FMUs."""
    monkeypatch.setattr(healthy_hours, "MINUTE", 3.0)
    monkeypatch.setattr(healthy_hours, "simulate", partial(simulate, folder=native.parent, build="native"))


def test_a_healthy_drive_is_without_fallback(short):
    for road in ROADS.values():
        of = residuals_on(road, 3)
        assert (of.samples, of.fallback) == (1501, 0)
        assert all(0.0 <= residual < 1.0 for residual in of[3:]), "of what leads to fallback"
        assert of.jump > 0.0
    one, other = Found(10, 1, 3, 0.2, 0.3, 0.1, 0.4), Found(20, 2, 4, 0.3, 0.2, 0.5, 0.1)
    assert worst([one, other]) == Found(30, 3, 7, 0.3, 0.3, 0.5, 0.4)


def test_a_drive_with_a_wheel_that_is_told_far_too_small_shows_as_fallback(short, monkeypatch):
    def with_another_wheel(road, seed):
        manoeuvre, errors = drive(road, seed)
        return manoeuvre, errors | {"can.g_w2": 0.8}

    seed = next(seed for seed in range(1, 100) if drive(ROADS["design model"], seed)[0].v_0 > 30.0)
    assert residuals_on(ROADS["design model"], seed).fallback == 0
    monkeypatch.setattr(healthy_hours, "drive", with_another_wheel)
    of = residuals_on(ROADS["design model"], seed)
    assert of.fallback > 0
    assert of.contradiction > 1.0


def test_a_drive_whose_half_swings_all_count_has_samples_with_less_damping(short, monkeypatch):
    def with_a_low_count(road, seed):
        manoeuvre, errors = drive(road, seed)
        return manoeuvre, errors | {"controller.swing": 1e-3, "controller.swing_decay": 0.01}

    assert residuals_on(ROADS["design model"], 7).feeding == 0
    monkeypatch.setattr(healthy_hours, "drive", with_a_low_count)
    of = residuals_on(ROADS["design model"], 7)
    assert 0 < of.feeding < of.samples
