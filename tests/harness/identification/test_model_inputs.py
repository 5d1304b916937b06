"""What drives the model between the samples."""

from dataclasses import replace

import numpy as np
import pytest

from driveline.harness.identification.drive_train import STEPS
from driveline.harness.identification.identify import of_sensors
from driveline.harness.identification.model_inputs import UNEVEN, model_inputs, parts
from driveline.harness.identification.torque_loop import TorqueLoop
from driveline.harness.recordings.measurement import Measurement
from driveline.harness.recordings.source import RecordingError
from tests.harness.identification.simulated import P

T_S = 0.002
TIME = 0.5 + T_S * np.arange(400)


def recording(
    time: np.ndarray = TIME, T_ref: np.ndarray | None = None, T_load: np.ndarray | None = None
) -> Measurement:
    T_mot, omega = 10.0 + np.sin(20.0 * time), 130.0 + np.cos(9.0 * time)
    return Measurement("drive", time, T_mot, omega, omega, None, None, T_load, T_ref, {}, (), (), {})


def test_the_parts_of_a_cubic_are_exact() -> None:
    cubic = np.polynomial.Polynomial([5.0, -2.0, 0.3, 0.01])
    found, integral = parts(cubic(np.arange(31)), T_S), cubic.integ()
    edges = np.arange(30 * STEPS + 1) / STEPS
    np.testing.assert_allclose(found, np.diff(integral(edges)).reshape(30, STEPS) * STEPS, rtol=1e-11)


def test_the_samples_have_their_torques_and_the_motor_speed_at_both_ends() -> None:
    load = -10.0 + 3.0 * np.sin(5.0 * TIME)
    drive, loop = model_inputs(recording(T_load=load))
    assert loop is None
    assert drive.T_s == pytest.approx(T_S, rel=1e-9)
    assert len(drive) == 399
    assert len(drive.omega_1) == 400
    middle = TIME[:-1, None] + T_S * (np.arange(STEPS) + 0.5) / STEPS
    np.testing.assert_allclose(drive.T_mot[3:-3], (10.0 + np.sin(20.0 * middle))[3:-3], atol=2e-5)
    np.testing.assert_allclose(drive.T_load[3:-3], (-10.0 + 3.0 * np.sin(5.0 * middle))[3:-3], atol=2e-5)


def test_a_load_torque_that_was_not_recorded_is_zero() -> None:
    assert not model_inputs(recording())[0].T_load.any()


def test_a_part_of_a_drive_is_that_of_its_samples() -> None:
    drive, _ = model_inputs(recording())
    part = drive.between(100, 250)
    assert len(part) == 150
    np.testing.assert_array_equal(part.omega_1, drive.omega_1[100:251])
    np.testing.assert_array_equal(part.T_mot, drive.T_mot[100:250])
    np.testing.assert_array_equal(part.T_load, drive.T_load[100:250])


def test_torques_act_as_much_before_they_are_recorded_as_they_are_later_than_the_motor_speed() -> None:
    """The mean of each part is that of the recorded signal so much later; a piece is that of the whole."""
    drive, _ = model_inputs(recording(T_load=-10.0 + 3.0 * np.sin(5.0 * TIME)))
    p = P._replace(late_1=-0.0004, late_T=0.0003, late_L=-0.001)
    middle = TIME[:-1, None] + T_S * (np.arange(STEPS) + 0.5) / STEPS
    acting, inside = drive.acting(p, 100, 250), slice(100, 250)
    np.testing.assert_allclose(acting.T_mot, (10.0 + np.sin(20.0 * (middle + 0.0007)))[inside], atol=2e-5)
    np.testing.assert_allclose(acting.T_load, (-10.0 + 3.0 * np.sin(5.0 * (middle - 0.0006)))[inside], atol=2e-5)
    np.testing.assert_array_equal(acting.omega_1, drive.omega_1[100:251])
    by_T, by_L = np.split(drive.d_acting(p, 100, 250).T, 2, axis=1)
    np.testing.assert_allclose(by_T, (20.0 * np.cos(20.0 * (middle + 0.0007)))[inside], rtol=1e-3, atol=1e-2)
    np.testing.assert_allclose(by_L, (15.0 * np.cos(5.0 * (middle - 0.0006)))[inside], rtol=1e-3, atol=1e-2)


def test_torques_that_are_not_late_are_those_that_were_recorded() -> None:
    drive, _ = model_inputs(recording())
    for p in (P, P._replace(late_1=0.001, late_T=0.001, late_L=0.001)):
        np.testing.assert_array_equal(drive.acting(p).T_mot, drive.T_mot)


def test_where_the_demand_is_known_the_motor_torque_has_no_noise() -> None:
    time = T_S * np.arange(1500)
    demand = 10.0 + 30.0 * np.sign(np.sin(40.0 * time + 0.1))
    given = replace(recording(time, demand), T_mot=TorqueLoop(0.004).torque(demand, T_S))
    drive, loop = model_inputs(given)
    assert loop is not None
    np.testing.assert_array_equal(drive.T_mot, loop.loop.means(demand, drive.T_s, STEPS)[:-1])


@pytest.mark.parametrize(("share", "used"), [(0.89, False), (0.91, True)])
def test_a_demand_that_does_not_explain_the_torque_does_not_replace_it(share: float, used: bool) -> None:
    time = T_S * np.arange(1500)
    demand = 10.0 + 30.0 * np.sign(np.sin(40.0 * time + 0.1))
    T = TorqueLoop(0.004).torque(demand, T_S)
    other = np.random.default_rng(1).standard_normal(len(T))
    given = replace(recording(time, demand), T_mot=T + other * T.std() * np.sqrt(1.0 / share - 1.0))
    drive, loop = model_inputs(given)
    assert loop is not None
    assert loop.explained == pytest.approx(share, abs=0.006)
    assert loop.answers == used
    assert np.array_equal(drive.T_mot, parts(given.T_mot, drive.T_s)) != used


def test_uneven_samples_are_refused_with_the_place() -> None:
    """A sample that comes late makes one interval long and the next short."""
    for late in (0.9 * UNEVEN, -0.9 * UNEVEN):
        time = TIME.copy()
        time[200] += late * T_S
        model_inputs(recording(time))
    time = TIME.copy()
    time[200:] += 0.2 * T_S
    with pytest.raises(RecordingError, match=r"drive: samples must be 0\.002001 s apart to within 5 %; after 0\.898 s"):
        model_inputs(recording(time))
    time = TIME.copy()
    time[200] += 1.1 * UNEVEN * T_S
    with pytest.raises(RecordingError, match=r"after 0\.(898|9) s it is 0\.00(211|189) s"):
        model_inputs(recording(time))


def test_the_motor_torque_has_its_noise_unless_it_is_the_answer_to_its_demand() -> None:
    time = T_S * np.arange(1500)
    demand, other = (10.0 + 30.0 * np.sign(np.sin(omega * time + 0.1)) for omega in (40.0, 17.0))
    noisy = TorqueLoop(0.004).torque(demand, T_S) + 0.3 * np.random.default_rng(1).standard_normal(len(time))
    right, wrong = (replace(recording(time, T_ref), T_mot=noisy) for T_ref in (demand, other))
    assert of_sensors(right, model_inputs(right)[1]).T_mot == 0.0
    for given in (wrong, replace(right, T_ref=None)):
        _, loop = model_inputs(given)
        assert of_sensors(given, loop if loop and loop.answers else None).T_mot == pytest.approx(0.3, rel=0.1)
