"""The force that keeps a simulated car at the recorded speed: how large, how slow, what brakes and grade do of it."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import ArrayLike

from driveline.harness.manoeuvres.catalogue import TOWN_DRIVE
from driveline.harness.manoeuvres.road_load import RoadLoad, Track
from driveline.harness.manoeuvres.speed_following import (
    F_BRAKE_MAX,
    F_UNCERTAIN,
    SIN_MAX,
    SLOW,
    STILL,
    brake_force,
    drive,
    holding,
    lacking_force,
    needed_force,
)
from driveline.harness.metrics.spectrum import band_rms
from driverecords.drive import read_drive

LOAD = RoadLoad(i=9.0, r=0.29, m=1450.0, g=9.81, c_rr=0.012, c_wa=0.42)
RESISTANCE = 1450.0 * 9.81 * 0.012
"""Of the tyres, in N."""


def track(
    v: ArrayLike, T_driver: ArrayLike = 0.0, slope: float = 0.0, interval: float = 0.1, samples: int = 400
) -> Track:
    """A drive of constant slope with these speeds and torques."""
    speeds, torques, slopes = (np.broadcast_to(x, samples).astype(float) for x in (v, T_driver, slope))
    return Track("drive", interval, np.arange(samples) * interval, speeds, torques, slopes)


def test_a_steady_drive_needs_what_the_motor_leaves_over_and_more_speed_the_mass():
    expected = RESISTANCE + 0.42 * 100.0 - 9.0 * 40.0 / 0.29
    assert needed_force(track(10.0, 40.0), LOAD) == pytest.approx(expected)
    level = needed_force(track(10.0), LOAD)[200]
    gaining = needed_force(track(10.0 + 0.1 * (np.arange(400) - 200)), LOAD)[200]
    assert gaining - level == pytest.approx(1.09 * 1450.0, rel=1e-3)


def test_a_car_lacks_the_force_that_slows_it_and_nothing_else():
    recorded = track(10.0 + np.sin(np.arange(400) * 0.1))
    assert lacking_force(recorded, LOAD, recorded.t, recorded.v) == pytest.approx(0.0)
    recorded, pull = track(10.0), 150.0
    behind = 10.0 - pull / (1.09 * 1450.0) * recorded.t[:50]
    lacking = lacking_force(track(10.0, samples=50), LOAD, recorded.t[:50], behind)
    assert lacking[20] == pytest.approx(pull + 0.42 * (100.0 - behind[20] ** 2), rel=0.01)


@pytest.mark.parametrize(("v", "tells"), [(0.99 * STILL, False), (1.01 * STILL, True)])
def test_a_car_that_brakes_may_hold_tells_nothing_of_the_forces(v, tells):
    recorded = track(10.0)
    for rolling, standing in ((recorded, np.full(400, v)), (track(v), recorded.v)):
        assert bool(lacking_force(rolling, LOAD, recorded.t, standing).any()) == tells


@pytest.mark.parametrize(("frequency", "most"), [(1.0, 0.01), (5.0, 1e-5), (8.0, 1e-5)])
def test_of_1_hz_less_than_a_hundredth_is_left_and_of_the_drive_train_nothing(frequency, most):
    t = np.arange(4000) * 0.01
    swing = np.sin(2.0 * np.pi * frequency * t)
    still, torque = track(10.0, 0.0, interval=0.01, samples=4000), track(10.0, swing, interval=0.01, samples=4000)
    middle = slice(500, 3500)
    of_torque = needed_force(torque, LOAD) - needed_force(still, LOAD)
    assert np.abs(of_torque[middle]).max() < most * LOAD.motor_force(np.ones(1))[0]
    swung = 10.0 + 0.01 * swing
    of_speed = lacking_force(still, LOAD, t, swung)
    force = LOAD.motion(swung, 0.01) - LOAD.motion(still.v, 0.01)
    assert np.abs(of_speed[middle]).max() < most * np.abs(force[middle]).max()


def test_brake_and_grade_are_the_force_but_for_the_band_of_the_drive_train():
    town = Track.of(read_drive(TOWN_DRIVE))
    F = needed_force(town, LOAD)
    rolling = ~holding(town, LOAD, F)
    manoeuvre = drive(town, LOAD, F)
    done = -manoeuvre.T_brake(town.t) / 0.29 - 1450.0 * 9.81 * np.sin(manoeuvre.slope(town.t))
    assert done[rolling] == pytest.approx(F[rolling])
    assert manoeuvre.T_brake(town.t)[rolling].max() > 100.0
    t = np.arange(2.5, 22.0, 0.002)
    for torque in (manoeuvre.T_brake(t), 0.29 * 1450.0 * 9.81 * np.sin(manoeuvre.slope(t))):
        assert band_rms(torque / 9.0, 0.002) < 0.005 < 2.0 < torque.std() / 9.0


@pytest.mark.parametrize(("surplus", "brake"), [(0.99 * F_UNCERTAIN, 0.0), (1.01 * F_UNCERTAIN, 0.01 * F_UNCERTAIN)])
def test_brakes_take_what_the_recorded_grade_and_a_doubt_leave_over(surplus, brake):
    for slope in (-0.05, 0.0, 0.05):
        F = np.full(400, -surplus - 1450.0 * 9.81 * np.sin(slope))
        assert brake_force(track(10.0, slope=slope), LOAD, F) == pytest.approx(brake, abs=1e-9)


@pytest.mark.parametrize(("v", "brakes"), [(1.01 * SLOW, False), (0.99 * SLOW, True)])
def test_a_slow_car_is_decelerated_by_the_brakes_alone(v, brakes):
    slowing = track(v + 1e-4 * (200 - np.arange(400)))
    by_the_motor = np.zeros(400)
    assert brake_force(slowing, LOAD, by_the_motor)[200] == pytest.approx(1.09 * 1450.0 * 1e-3 if brakes else 0.0)


def test_brakes_and_grade_have_limits_and_a_rough_foot_holds_its_torque():
    manoeuvre = drive(track(10.0), LOAD, np.full(400, -1e6))
    assert manoeuvre.T_brake(20.0) == pytest.approx(0.29 * F_BRAKE_MAX)
    assert np.sin(manoeuvre.slope(20.0)) == pytest.approx(SIN_MAX)
    recorded = replace(track(10.0), T_driver=np.arange(400.0))
    F = needed_force(recorded, LOAD)
    held, smooth = drive(recorded, LOAD, F, held=0.5), drive(recorded, LOAD, F)
    assert held.T_driver([0.0, 0.499, 0.5, 1.7, 2.0]) == pytest.approx([0, 0, 5, 15, 20])
    assert smooth.T_driver([0.25]) == pytest.approx([2.5])
    assert held.T_brake([1.0]) == smooth.T_brake([1.0])


@pytest.mark.parametrize(("push", "held"), [(0.99 * F_UNCERTAIN, True), (1.01 * F_UNCERTAIN, False)])
def test_a_standing_car_is_held_until_its_driver_drives(push, held):
    torque, nothing = push * 0.29 / 9.0, np.zeros(400)
    assert holding(track(0.0, torque), LOAD, nothing).all() == held
    assert not holding(track(0.1, torque), LOAD, nothing).any()
    # a force that pushes it back takes part of the driver's
    assert holding(track(0.0, torque), LOAD, nothing - 10.0).all()
    assert holding(track(0.0, torque), LOAD, nothing + 10.0).all() == held
    manoeuvre = drive(track(0.0, torque), LOAD, nothing)
    assert manoeuvre.T_brake(20.0) == pytest.approx(0.29 * F_BRAKE_MAX if held else 0.0)
