"""A recording to identify from: the forms in which speeds and torques of the wheels come."""

import json
from pathlib import Path

import numpy as np
import pytest

from driverecords.measurement import Measurement, read_measurement
from driverecords.source import RecordingError

from .car import RADIUS, RATIO, drive
from .conftest import Write

pytestmark = pytest.mark.usefixtures("read_here")

RPM = 2.0 * np.pi / 60.0
MOTOR = {
    "Time [s]": drive()["time"],
    "Motor Torque [Nm]": drive()["T_mot"],
    "Motor Speed [rpm]": drive()["omega_1"] / RPM,
}
WHEEL, LOAD = drive()["omega_2"] / RATIO, -RATIO * drive()["T_load"]


def require_same(recording: Measurement, *names: str) -> None:
    for name in names:
        np.testing.assert_allclose(getattr(recording, name), drive()[name], rtol=1e-8, atol=1e-7, err_msg=name)


@pytest.mark.parametrize(
    "wheels",
    [
        {"Wheel Speed [rad/s]": WHEEL},
        {"Wheel Speed [km/h]": 3.6 * RADIUS * WHEEL},
        {"omega_2 [rad/s]": RATIO * WHEEL},
        {"Wheel Speed FL (km/h)": 3.6 * RADIUS * (WHEEL + 0.1), "Wheel Speed FR (km/h)": 3.6 * RADIUS * (WHEEL - 0.1)},
        {"wheel_speed_left_rpm": (WHEEL + 0.1) / RPM, "wheel_speed_right_rpm": (WHEEL - 0.1) / RPM},
    ],
)
def test_the_speed_of_the_wheels_in_every_form(write: Write, wheels: dict[str, np.ndarray]) -> None:
    recording = read_measurement(write(MOTOR | wheels), RATIO, RADIUS)
    require_same(recording, "time", "T_mot", "omega_1", "omega_2")
    assert (recording.T_load, recording.valid, recording.counter) == (None, None, None)
    assert recording.columns["omega_2"] == " and ".join(wheels)


@pytest.mark.parametrize(
    ("heading", "factor", "message"),
    [
        ("Wheel Speed [rpm]", RATIO * RPM, "in rpm, wheel side"),
        ("Wheel Speed [km/h]", RATIO / RADIUS / 3.6, "in km/h, over ground"),
        ("omega_2 [1/min]", RPM, "in 1/min, motor side"),
    ],
)
def test_it_is_known_how_the_file_writes_the_wheel_speed(
    write: Write, heading: str, factor: float, message: str
) -> None:
    column = drive()["omega_2"] / factor
    recording = read_measurement(write(MOTOR | {heading: column}), RATIO, RADIUS)
    file_unit = recording.file_units["omega_2"]
    assert str(file_unit) == message
    assert recording.omega_2 / file_unit.factor == pytest.approx(column)
    assert recording.omega_1 / recording.file_units["omega_1"].factor == pytest.approx(MOTOR["Motor Speed [rpm]"])
    assert str(recording.file_units["T_mot"]) == "in Nm"


@pytest.mark.parametrize(
    ("heading", "factor", "message"),
    [
        ("Wheel Torque [kNm]", -1e3 / RATIO, "in kNm, wheel side"),
        ("Load Torque [N.m]", 1.0, "in N·m, motor side"),
    ],
)
def test_it_is_known_how_the_file_writes_the_load(write: Write, heading: str, factor: float, message: str) -> None:
    column = drive()["T_load"] / factor
    path = write(MOTOR | {"Wheel Speed [rad/s]": WHEEL, heading: column})
    recording = read_measurement(path, RATIO, RADIUS)
    assert str(recording.file_units["T_load"]) == message
    assert recording.T_load is not None
    assert abs(recording.T_load) / recording.file_units["T_load"].factor == pytest.approx(abs(column))


@pytest.mark.parametrize(
    "wheels",
    [
        {"Wheel Torque [Nm]": LOAD},
        {"Load Torque [Nm]": -LOAD / RATIO},
        {"Wheel Torque L [kNm]": 1e-3 * (0.5 * LOAD + 9.0), "Wheel Torque R [kNm]": 1e-3 * (0.5 * LOAD - 9.0)},
    ],
)
def test_measurement_wheels_show_a_driving_torque_as_positive(write: Write, wheels: dict[str, np.ndarray]) -> None:
    path = write(MOTOR | {"Wheel Speed [rad/s]": WHEEL} | wheels)
    require_same(read_measurement(path, RATIO, RADIUS), "T_load")


def test_validity_and_counter_of_the_messages(write: Write) -> None:
    count = np.floor(drive()["time"] / 0.02)
    path = write(MOTOR | {"Wheel Speed [rad/s]": WHEEL, "Wheel Speed Valid": count % 2, "Wheel Speed Counter": count})
    recording = read_measurement(path, RATIO, RADIUS)
    assert recording.valid is not None
    assert recording.valid.dtype == bool
    assert recording.counter is not None
    np.testing.assert_array_equal(recording.valid, count % 2 == 1.0)
    np.testing.assert_array_equal(recording.counter, count)


@pytest.mark.parametrize("heading", ["Torque Demand [N.m]", "torque_request_Nm", "M_soll (Nm)", "T_ref [N·m]"])
def test_the_torque_demand_under_its_names(write: Write, heading: str) -> None:
    columns = MOTOR | {"Wheel Speed [rad/s]": WHEEL}
    assert read_measurement(write(columns), RATIO, RADIUS).T_ref is None
    recording = read_measurement(write(columns | {heading: drive()["T_ref"]}), RATIO, RADIUS)
    require_same(recording, "T_mot", "T_ref")
    assert recording.columns["T_ref"] == heading


def test_without_a_wheel_speed_it_is_refused(write: Write) -> None:
    with pytest.raises(RecordingError, match=r"no column Wheel Speed \[km/h\] .*--column omega_wheel=HEADING"):
        read_measurement(write(MOTOR), RATIO, RADIUS)


def test_columns_that_are_given_with_unit_and_sign(write: Write) -> None:
    path = write(
        {"Time [s]": MOTOR["Time [s]"], "M": -drive()["T_mot"], "n_EM1": MOTOR["Motor Speed [rpm]"], "x [rad/s]": WHEEL}
    )
    headings = {"T_mot": "-M [Nm]", "omega_1": "n_EM1 [rpm]", "omega_wheel": "x"}
    require_same(read_measurement(path, RATIO, RADIUS, headings), "T_mot", "omega_1", "omega_2")


def test_results_of_ours_have_their_units_in_the_file_beside_them(write: Write) -> None:
    names = {
        "time": ("time", "s"),
        "motor.T_mot_est": ("T_mot", "N.m"),
        "motor.omega_1_meas": ("omega_1", "rad/s"),
        "can.omega_2_can": ("omega_2", "rad/s"),
        "plant.T_load": ("T_load", "N.m"),
    }
    path = write({column: drive()[name] for column, (name, _) in names.items()})
    with pytest.raises(
        RecordingError,
        match=r"can\.omega_2_can has no unit; .*, as in .* with --column omega_2='can\.omega_2_can \[rad/s\]'",
    ):
        read_measurement(path, RATIO, RADIUS)
    record = {"files": [path.name], "units": {column: unit for column, (_, unit) in names.items()}}
    path.with_suffix(".json").write_text(json.dumps(record), encoding="utf-8")
    require_same(read_measurement(path, RATIO, RADIUS), "time", "T_mot", "omega_1", "omega_2", "T_load")


def test_all_that_is_missing_is_named_at_once_and_samples_that_are_too_far_apart(write: Write) -> None:
    slow = {"Time [s]": drive()["time"][::50], "Motor Speed [rpm]": drive()["omega_1"][::50] / RPM}
    columns = r"no column Motor Torque \[Nm\], Wheel Speed \[km/h\]; the file has: Time, Motor Speed; "
    which = r"--column QUANTITY=HEADING says which one is T_mot or omega_wheel; "
    every = r"Motor Speed \[rpm\] has a sample every 100 ms; 10 ms or less are needed to identify anything$"
    with pytest.raises(RecordingError, match=columns + which + every):
        read_measurement(write(slow), RATIO, RADIUS)


def test_a_record_of_other_files_says_nothing_of_this_one(write: Write) -> None:
    path = write({"time": drive()["time"], "motor.omega_1_meas": drive()["omega_1"]})
    record = {"files": ["other.csv"], "units": {"time": "s", "motor.omega_1_meas": "rad/s"}}
    path.with_suffix(".json").write_text(json.dumps(record), encoding="utf-8")
    with pytest.raises(RecordingError, match="time has no unit"):
        read_measurement(path, RATIO, RADIUS)


def test_a_logger_with_fast_sensors_and_messages_of_the_bus(tmp_path: Path) -> None:
    """Motor at 1 kHz, torque of the wheels at 500 Hz with an offset of a sample, speed of the wheels as messages."""
    from asammdf import MDF, Signal

    signals, time = drive(10.0, 0.001), drive(10.0, 0.001)["time"]
    late = time[1::2]
    messages = np.arange(0.013, 10.0, 0.02)
    wheel = np.interp(messages, time, signals["omega_2"]) / RATIO
    with MDF(version="4.10") as file:
        motor = [
            ("n", signals["omega_1"] / RPM, "1/min", "Motor Speed"),
            ("T", signals["T_mot"], "N·m", "Motor Torque"),
        ]
        file.append([Signal(x, time, unit=unit, name=name) for _, x, unit, name in motor], common_timebase=True)
        torque = -RATIO * np.interp(late, time, signals["T_load"])
        file.append([Signal(torque, late, unit="Nm", name="Wheel Torque")], common_timebase=True)
        file.append([Signal(wheel, messages, unit="rad/s", name="Wheel Speed")], common_timebase=True)
        file.save(tmp_path / "logged.mf4")
    recording = read_measurement(tmp_path / "logged.mf4", RATIO, RADIUS)
    part = (time >= 0.013) & (time <= late[-1])
    np.testing.assert_array_equal(recording.time, time[part])
    np.testing.assert_allclose(recording.omega_1, signals["omega_1"][part], rtol=1e-12)
    assert recording.T_load is not None
    np.testing.assert_allclose(recording.T_load[1:-1], signals["T_load"][part][1:-1], atol=2e-3)
    assert set(np.round(recording.omega_2, 6)) <= set(np.round(RATIO * wheel, 6)), "held between messages"
    assert np.argmax(np.diff(recording.omega_2) != 0.0) == 19, "until the next one has come"


@pytest.mark.parametrize("interval", [0.003, 0.0105])
def test_a_demand_that_was_sampled_otherwise_is_held_and_not_interpolated(tmp_path: Path, interval: float) -> None:
    from asammdf import MDF, Signal

    signals = drive()
    sent = np.arange(0.0, 10.0, interval)
    demand = signals["T_ref"][(sent / 0.002 + 1e-6).astype(int)]
    with MDF(version="4.10") as file:
        motor = [("omega_1", "rad/s"), ("T_mot", "Nm"), ("omega_2", "rad/s")]
        file.append(
            [Signal(signals[name], signals["time"], unit=unit, name=name) for name, unit in motor], common_timebase=True
        )
        file.append([Signal(demand, sent, unit="Nm", name="Torque Demand")], common_timebase=True)
        file.save(tmp_path / "logged.mf4")
    recording = read_measurement(tmp_path / "logged.mf4", RATIO, RADIUS)
    np.testing.assert_array_equal(recording.T_ref, demand[np.searchsorted(sent, recording.time, side="right") - 1])
