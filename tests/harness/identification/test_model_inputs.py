"""What drives the model between the samples."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.ndimage import minimum_filter1d

from driveline.harness.identification.drive_train import STEPS
from driveline.harness.identification.identify import of_sensors
from driveline.harness.identification.model_inputs import GAP, UNEVEN, drive_of
from driveline.harness.identification.torque_loop import MET, TorqueLoop
from driverecords.measurement import Measurement
from driverecords.source import RecordingError

T_S = 0.002
TIME = 0.5 + T_S * np.arange(400)
MIDDLE = TIME[:-1, None] + T_S * (np.arange(STEPS) + 0.5) / STEPS


def recording(time: np.ndarray = TIME, T_ref: np.ndarray | None = None) -> Measurement:
    T_mot, omega = 10.0 + np.sin(20.0 * time), 130.0 + np.cos(9.0 * time)
    T_load = -10.0 + 3.0 * np.sin(5.0 * time)
    return Measurement("drive", time, T_mot, omega, omega, None, None, T_load, T_ref, {}, (), {})


@pytest.mark.parametrize("late", [0.0, 0.0007, -0.0031])
def test_a_torque_acts_as_much_before_it_is_recorded_as_it_is_late(late: float) -> None:
    drive, loop = drive_of(recording())
    assert loop is None
    assert len(drive) == 399
    for _ in range(2):  # it is kept
        torque = drive.torque(late)
        np.testing.assert_allclose(torque[12:-12], (10.0 + np.sin(20.0 * (MIDDLE + late)))[12:-12], atol=2e-5)


def test_a_part_of_a_drive_is_that_of_its_samples() -> None:
    drive, _ = drive_of(recording())
    part = replace(drive, exact=np.arange(400) > 200).between(100, 250)
    assert len(part) == 150
    for name in ("omega_1", "T_mot", "T_load"):
        np.testing.assert_array_equal(getattr(part, name), getattr(drive, name)[100:251])
    assert part.exact is not None
    assert part.exact.sum() == 50


def test_where_the_demand_explains_the_torque_it_has_no_noise_and_elsewhere_it_is_the_recorded_one() -> None:
    """A step of the demand that was logged 2 ms early."""
    time = T_S * np.arange(1500)
    demand = 10.0 + 30.0 * np.sign(np.sin(20.0 * time + 0.1))
    noise = 0.3 * np.random.default_rng(1).standard_normal(len(time))
    exact = TorqueLoop(0.004).torque(demand, T_S)
    early = demand.copy()
    step = int(np.flatnonzero(np.diff(demand))[8])
    early[step] = demand[step + 1]
    given = replace(recording(time, early), T_mot=exact + noise)
    drive, loop = drive_of(given)
    assert loop is not None
    assert drive.exact is not None
    at = np.arange(step, step + 8)
    assert not drive.exact[at].any()
    np.testing.assert_array_equal(drive.T_mot[at], given.T_mot[at])
    assert drive.exact[100:].mean() > 0.9
    assert np.abs(drive.T_mot - exact)[drive.exact].max() < MET * 0.3
    assert of_sensors(drive, given.T_mot).T_mot == pytest.approx(0.3, rel=0.1)


@pytest.mark.parametrize("late", [0.0, 0.001, -0.0007])
def test_the_torque_of_the_demand_is_known_between_the_samples(late: float) -> None:
    """To a third of its noise, where a spline through the samples misses by its noise."""
    time = T_S * np.arange(1500)
    demand = 10.0 + 30.0 * np.sign(np.sin(20.0 * time + 0.1))
    noise = 0.3 * np.random.default_rng(1).standard_normal(len(time))
    T_mot = TorqueLoop(0.004).torque(demand, T_S)
    drive, loop = drive_of(replace(recording(time, demand), T_mot=T_mot + noise))
    assert loop is not None
    assert drive.exact is not None
    parts = T_S * (np.arange(STEPS) + 0.5) / STEPS + late
    true = np.column_stack([replace(loop.loop, delay=loop.loop.delay - by).torque(demand, T_S) for by in parts])[:-1]
    at = np.flatnonzero(minimum_filter1d(drive.exact, 7)[:-1])
    assert np.abs(drive.torque(late) - true)[at].max() < 0.1
    by_samples = np.abs(replace(drive, fine=None).torque(late) - true)[at].max()
    assert by_samples > 0.3
    part = drive.between(100, 900)
    np.testing.assert_allclose(part.torque(late)[20:-20], drive.torque(late)[120:880], atol=1e-4)


@pytest.mark.parametrize(("share", "used"), [(0.89, False), (0.91, True)])
def test_a_demand_that_does_not_explain_the_torque_does_not_replace_it(share: float, used: bool) -> None:
    time = T_S * np.arange(1500)
    demand = 10.0 + 30.0 * np.sign(np.sin(40.0 * time + 0.1))
    T = TorqueLoop(0.004).torque(demand, T_S)
    other = np.random.default_rng(1).standard_normal(len(T))
    given = replace(recording(time, demand), T_mot=T + other * T.std() * np.sqrt(1.0 / share - 1.0))
    drive, loop = drive_of(given)
    assert loop is not None
    assert loop.explained == pytest.approx(share, abs=0.006)
    assert loop.answers == used
    assert np.array_equal(drive.T_mot, given.T_mot) != used


@pytest.mark.parametrize("samples", [1.01 * GAP, 300.0])
def test_a_gap_parts_two_pieces_and_no_torque_is_between_them(samples: float) -> None:
    time = T_S * (np.arange(1000) + (samples - 1.0) * (np.arange(1000) >= 600))
    drive, _ = drive_of(recording(time))
    assert drive.pieces == [(0, 599), (600, 999)]
    assert drive.longest == slice(0, 600)
    assert drive.T_s == pytest.approx(T_S)
    torque = drive.torque(0.0007)
    assert np.flatnonzero(np.isnan(torque[:, 0])).tolist() == [599]
    for piece, (first, last) in zip(map(drive.between, (0, 600), (599, 999)), drive.pieces, strict=True):
        assert piece.starts == (0,)
        np.testing.assert_allclose(torque[first:last], piece.torque(0.0007), rtol=1e-12)
    assert drive.between(100, 800).pieces == [(0, 499), (500, 700)]


def test_uneven_samples_are_refused_with_the_place() -> None:
    """A sample that comes late makes one interval long and the next short."""
    for late in (0.9 * UNEVEN, -0.9 * UNEVEN):
        time = TIME.copy()
        time[200] += late * T_S
        drive_of(recording(time))
    time = TIME.copy()
    time[200:] += 0.2 * T_S
    with pytest.raises(RecordingError, match=r"drive: samples must be 0\.002001 s apart to within 5 %; after 0\.898 s"):
        drive_of(recording(time))
    with pytest.raises(RecordingError, match=r"after .* s it is .* s; record at a fixed rate"):
        drive_of(recording(np.delete(TIME, np.arange(102, 390, 2))))
    time = TIME.copy()
    time[200] += 1.1 * UNEVEN * T_S
    with pytest.raises(RecordingError, match=r"after 0\.(898|9) s it is 0\.00(211|189) s"):
        drive_of(recording(time))
