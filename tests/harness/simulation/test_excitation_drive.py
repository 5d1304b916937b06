"""The test drive, recorded as a real car would."""

import json
import re
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest

from driveline.harness.commands.cli import main
from driveline.harness.commands.record import Arguments
from driveline.harness.manoeuvres.prbs import FEEDBACK, binary_torque, shift_register
from driveline.harness.manoeuvres.road_load import RoadLoad
from driveline.harness.simulation.excitation_drive import MeasurementWheels, holding_slope, require_demand
from driveline.harness.simulation.simulate import simulate
from driverecords.measurement import Measurement, read_measurement
from fmuloop.errors import WiringError

CAR = RoadLoad(i=9.0, r=0.29, m=1450.0, g=9.81, c_rr=0.012, c_wa=0.42)
QUICK = ["record", "--duration", "2.5", "--quiet"]


@pytest.fixture
def record(both_built: Path, tmp_path: Path):
    """Runs the command; gives the file."""

    def record(*options: str, plant: str = "TwoMassDriveline", control: str = "off", into: str = "one") -> Path:
        output = tmp_path / into
        given = ["--plant", plant, "--control", control, "--fmus", str(both_built), "--output", str(output), *options]
        assert main([*QUICK, *given]) == 0
        return output / f"{plant}_prbs_{'DampingController' if control == 'on' else control}.csv"

    return record


def read(path: Path) -> Measurement:
    return read_measurement(path, CAR.i, CAR.r)


@pytest.mark.parametrize("order", FEEDBACK)
def test_a_sequence_has_the_greatest_length_that_its_order_can(order: int) -> None:
    period = 2**order - 1
    bits = shift_register(2 * period, order)
    assert bits[:period] == bits[period:]
    states = {tuple(bits[k : k + order]) for k in range(period)}
    assert len(states) == period, "every state but that of zeros"


def test_the_demand_has_mean_and_amplitude_and_jumps_with_its_clock() -> None:
    T = binary_torque("prbs", 5.0, 20.0, 0.06, 7, 127 * 0.06, 4.0).T_driver(np.arange(127) * 0.06 + 0.03)
    assert set(T) == {25.0, -15.0}
    assert T.mean() == pytest.approx(5.0, abs=20.0 / 127.0 + 1e-9), "one more high than low"


@pytest.mark.parametrize("plant", ["TwoMassDriveline", "ValidationVehicle"])
@pytest.mark.parametrize("control", ["off", "on"])
def test_what_is_written_is_read_back_without_a_warning(record, plant: str, control: str) -> None:
    found = read(record(plant=plant, control=control))
    assert found.warnings == []
    assert len(found.time) == 1251
    np.testing.assert_allclose(np.diff(found.time), 0.002, rtol=1e-9)
    assert found.valid is not None
    assert found.valid.all()
    assert found.counter is not None
    assert 90 <= found.counter[-1] <= 125, "a message every 20 ms"
    assert found.T_load is not None


def test_the_recording_is_what_the_sensors_of_the_loop_have_shown(record, both_built: Path) -> None:
    """Without errors of the measurement wheels, T_load of the plant comes back: no brake acts."""
    found = read(record("--noise", "0", "--offset", "0", "--gain-error", "0", "--seed", "3"))
    slope = holding_slope(CAR, 10.0, 15.0 / 3.6)
    manoeuvre = binary_torque("prbs", 10.0, 30.0, 0.04, 9, 2.5, 15.0 / 3.6, slope)
    results = simulate(manoeuvre, control=False, seed=3, folder=both_built)[::2]
    for name, column in {
        "T_mot": "motor.T_mot_est",
        "T_ref": "controller.T_ref",
        "omega_1": "motor.omega_1_meas",
        "omega_2": "can.omega_2_can",
        "T_load": "plant.T_load",
        "counter": "can.counter",
    }.items():
        np.testing.assert_allclose(getattr(found, name), results[column], atol=1e-5, err_msg=name)


def test_the_errors_of_the_measurement_wheels_are_those_that_are_given(record) -> None:
    clean = read(record("--noise", "0", "--offset", "0", "--gain-error", "0"))
    found = read(record("--noise", "10", "--offset", "8", "--gain-error", "0.01", into="other"))
    assert clean.T_load is not None
    assert found.T_load is not None
    error = -9.0 * (found.T_load - 1.01 * clean.T_load)
    assert error.mean() == pytest.approx(8.0, abs=4.0 * 10.0 / np.sqrt(len(error)))
    assert error.std() == pytest.approx(10.0, rel=0.1)
    assert abs(np.corrcoef(error[1:], error[:-1])[0, 1]) < 0.12, "white"


def test_same_input_same_bytes_and_another_seed_others(record) -> None:
    first, again, other = record(), record(into="again"), record("--seed", "2", into="other")
    assert first.read_bytes() == again.read_bytes()
    assert first.read_bytes() != other.read_bytes()
    assert first.read_text().splitlines()[0] == (
        "Time [s],Motor Speed [rad/s],Motor Torque [N.m],Torque Demand [N.m],Wheel Speed [rad/s],Wheel Speed Valid [1],"
        "Wheel Speed Counter [1],Wheel Torque [N.m]"
    )


def test_what_made_it_stands_beside_it_and_another_drive_does_not_replace_it(record, capsys) -> None:
    path = record("--amplitude", "25")
    made = json.loads(path.with_suffix(".json").read_text(encoding="utf-8"))
    assert list(made["files"]) == [path.name]
    assert made["run"]["demand"] == {
        "mean": 10.0, "amplitude": 25.0, "clock": 0.04, "order": 9, "duration": 2.5, "speed": 15.0,
        "slope": made["run"]["demand"]["slope"],
    }  # fmt: skip
    assert made["run"]["measurement_wheels"] == {"noise": 10.0, "offset": 8.0, "gain_error": 0.01}
    given = ["--output", str(path.parent), "--fmus", str(path.parent)]
    assert main([*QUICK, "--amplitude", "20", *given]) == 2
    assert path.is_file()


@pytest.mark.parametrize("plant", ["TwoMassDriveline", "ValidationVehicle"])
def test_the_road_about_holds_the_speed(both_built: Path, plant: str) -> None:
    drifts = []
    for slope in (0.0, holding_slope(CAR, 30.0, 10.0)):
        manoeuvre = binary_torque("prbs", 30.0, 30.0, 0.04, 9, 0.04 * 127, 10.0, slope)
        v = simulate(manoeuvre, plant=plant, control=False, folder=both_built)["plant.v"]
        drifts.append(abs(v[-1] - v[0]))
    assert drifts[1] < 0.3 < 1.5 < drifts[0]


def test_a_demand_that_the_car_would_not_follow_is_refused() -> None:
    for mean in (10.0, -10.0):
        require_demand(mean, 170.0, 0.002, 180.0)
        with pytest.raises(WiringError, match=rf"{mean:g} \+- 170\.1 N\.m is beyond the 180 N\.m"):
            require_demand(mean, 170.1, 0.04, 180.0)
    with pytest.raises(WiringError, match=r"a clock of 0\.0019 s is shorter"):
        require_demand(10.0, 30.0, 0.0019, 180.0)


def test_a_mean_that_no_road_holds_is_refused() -> None:
    assert holding_slope(CAR, 5.7, 15.0 / 3.6) == pytest.approx(0.0, abs=1e-3)
    with pytest.raises(WiringError, match="at most 40 % can be"):
        holding_slope(CAR, 200.0, 15.0 / 3.6)


def test_measurement_wheels_without_errors_show_the_torque() -> None:
    T_rim = np.linspace(-500.0, 500.0, 11)
    assert MeasurementWheels(0.0, 0.0, 0.0).measured(T_rim, 1).tolist() == T_rim.tolist()


@pytest.mark.parametrize(
    "option", [["--order", "4"], ["--order", "13"], ["--noise", "-1"], ["--mean", "x"], ["--clock", "0"]]
)
def test_options_that_are_no_drive(option: list[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main(["record", *option])
    assert end.value.code == 2


def test_without_options_the_measurement_wheels_are_those_of_a_program():
    given = vars(Arguments())
    assert {name: given[name] for name in asdict(MeasurementWheels())} == asdict(MeasurementWheels())


def test_the_speed_is_told_in_kilometres_per_hour(native, tmp_path, capsys):
    options = ["--speed", "40", "--duration", "2.5", "--fmus", str(native.parent), "--output", str(tmp_path)]
    assert main(["record", *options]) == 0
    (found,) = re.findall(r"speed ([\d.]+) to ([\d.]+) km/h", capsys.readouterr().out)
    assert [float(each) for each in found] == pytest.approx([40.0, 40.0], rel=0.1)
