"""The frames of a run, read again by the libraries of the trade and by our own commands."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from driveline.harness.commands.cli import main
from driveline.harness.exchange.bus.database import telegrams, write_dbc
from driveline.harness.exchange.bus.log import write_log
from driveline.models.wheel_speed_can import FRAME, Parameters
from driverecords.channels import Channels
from driverecords.drive import read_drive
from driverecords.measurement import read_measurement

pytestmark = pytest.mark.usefixtures("read_here")

LOGS = ("asc", "blf")
P = Parameters()

RESOLUTION = {"asc": 5.1e-7, "blf": 1.1e-9}
"""Of the times in s: ASC has six decimals, BLF nanoseconds."""


@pytest.fixture(scope="module", params=LOGS)
def log(request, results, tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("log") / f"run.{request.param}"
    write_log(telegrams({}), results, path)
    write_dbc(telegrams({}), path.with_suffix(".dbc"))
    return path


def arrivals(results: np.ndarray) -> np.ndarray:
    """Rows at which messages of the wheel speed have arrived."""
    return np.flatnonzero(np.diff(results["can.counter"])) + 1


def test_python_can_and_cantools_find_what_the_controller_received(log: Path, results) -> None:
    import can
    import cantools

    database: Any = cantools.database.load_file(log.with_suffix(".dbc"))
    with can.LogReader(log) as reader:
        frames = [frame for frame in reader if frame.arbitration_id == FRAME.identifier]
    rows = arrivals(results)
    assert len(rows) < 0.95 * results["time"][-1] / P.T_cyc, "some are lost"
    np.testing.assert_allclose(
        [frame.timestamp for frame in frames], results["time"][rows], atol=RESOLUTION[log.suffix[1:]]
    )
    contents = [database.decode_message(frame.arbitration_id, frame.data) for frame in frames]
    received = 3.6 * results["can.omega_2_can"][rows] * P.r / P.i
    np.testing.assert_allclose([content["Wheel_Speed"] for content in contents], received, rtol=1e-12, atol=1e-12)
    assert [content["Wheel_Speed_Valid"] for content in contents] == results["can.valid"][rows].astype(int).tolist()
    assert [content["Wheel_Speed_Counter"] for content in contents] == (results["can.counter"][rows] % 256).tolist()
    assert {content["Wheel_Speed_Valid"] for content in contents} == {0, 1}
    before = log.read_bytes()
    write_log(telegrams({}), results, log)
    assert log.read_bytes() == before


def test_what_motor_control_says_is_in_the_log_at_every_cycle_to_single_precision(log: Path, results) -> None:
    channels = Channels(log, databases=[log.with_suffix(".dbc")]).read("T_mot", "omega_1", "T_ref")
    columns = {"T_mot": "motor.T_mot_est", "omega_1": "motor.omega_1_meas", "T_ref": "controller.T_ref"}
    for quantity, column in columns.items():
        np.testing.assert_allclose(channels[quantity].time, results["time"][::2], atol=RESOLUTION[log.suffix[1:]])
        np.testing.assert_array_equal(channels[quantity].values, results[column][::2].astype(np.float32))


def test_the_log_is_read_as_a_drive_with_the_speed_of_the_wheels_and_as_a_measurement(log, results) -> None:
    drive = read_drive(log, databases=[log.with_suffix(".dbc")])
    rows = arrivals(results)
    last = rows[np.searchsorted(results["time"][rows], drive.time + 1e-6) - 1]
    np.testing.assert_allclose(drive.v, results["can.omega_2_can"][last] * P.r / P.i, rtol=1e-12, atol=1e-12)
    assert drive.elevation is None
    found = read_measurement(log, P.i, P.r, databases=[log.with_suffix(".dbc")])
    assert found.valid is not None
    assert {*found.valid.tolist()} == {False, True}
    assert found.T_ref is not None
    assert found.T_load is None


def test_a_gain_error_of_the_receiver_is_not_on_the_bus(results, tmp_path: Path) -> None:
    off = results.copy()
    off["can.omega_2_can"] *= 1.05
    path = tmp_path / "run.blf"
    write_log(telegrams({"can": {"g_w2": 1.05}}), off, path)
    write_dbc(telegrams({"can": {"g_w2": 1.05}}), tmp_path / "run.dbc")
    v = Channels(path, databases=[tmp_path / "run.dbc"]).read("omega_wheel")["omega_wheel"]
    np.testing.assert_allclose(
        v.values, results["can.omega_2_can"][arrivals(results)] * P.r / P.i, rtol=1e-12, atol=1e-12
    )


@pytest.mark.slow
@pytest.mark.parametrize("form", LOGS)
def test_a_run_is_logged_and_replayed(native, tmp_path: Path, form: str, capsys: pytest.CaptureFixture[str]) -> None:
    options = ["--fmus", str(native.parent), "--output", str(tmp_path), "--quiet"]
    assert main(["simulate", "--manoeuvre", "tipin15", "--frames", form, *options]) == 0
    stem = tmp_path / "TwoMassDriveline_tipin15_DampingController"
    recording = ["replay", f"{stem}.{form}", "--plant", "TwoMassDriveline", *options]
    assert main(recording) == 2
    assert "give the database that says what they mean, --dbc FILE" in capsys.readouterr().err
    assert main([*recording, "--dbc", f"{stem}.dbc", "--replace"]) == 0
    assert (tmp_path / f"{stem.name}_DampingController.csv").is_file()


def test_frames_of_a_test_drive_are_written_beside_it_but_none_for_a_bus_of_somebody_else(
    native, tmp_path, capsys
) -> None:
    options = ["--fmus", str(native.parent), "--output", str(tmp_path), "--quiet"]
    assert main(["record", "--duration", "4", "--frames", "blf", *options]) == 0
    stem = tmp_path / "TwoMassDriveline_prbs_off"
    found = read_measurement(stem.with_suffix(".blf"), P.i, P.r, databases=[stem.with_suffix(".dbc")])
    other = read_measurement(stem.with_suffix(".csv"), P.i, P.r)
    shared = np.searchsorted(other.time, found.time - 1e-6)
    np.testing.assert_allclose(found.omega_1, other.omega_1[shared], atol=1e-4)
    # the speed is that of the wheels times i in both: over ground on the bus, of the wheels in the table
    np.testing.assert_allclose(found.omega_2, other.omega_2[shared], atol=1e-4)
    theirs = tmp_path / "theirs.fmu"
    theirs.write_bytes((native / "WheelSpeedCan.fmu").read_bytes())
    options = ["--can", str(theirs), "--fmus", str(native.parent), "--output", str(tmp_path / "out")]
    assert main(["simulate", *options, "--frames", "blf"]) == 2
    assert f"--frames: {theirs} declares no frames" in capsys.readouterr().err
