"""One tip-in tells the stiffness, and the gap if it crosses it, on either plant."""

from pathlib import Path

import numpy as np
import pytest

from docs.studies.one_step import recorded
from driveline.fmus.building.parameter_files import read_vehicle
from driveline.harness.commands.cli import main
from driveline.harness.commands.identify_step import WIDEST, _lines
from driveline.harness.identification.step import identify_step, tip
from driveline.harness.loop.settings import Settings
from driverecords.measurement import Measurement
from driverecords.source import RecordingError

CAR = {"C": 95.0, "phi_B": 0.22, "m": 1600.0}


def recording(
    at: float = 1.0, height: float = 80.0, until: float = 2.0, rise: float = 0.0, before: float = -10.0
) -> Measurement:
    time = np.arange(0.0, until, 0.002)
    noise = np.random.default_rng(1).standard_normal((2, len(time)))
    T_mot = before + height * np.clip((time - at) / max(rise, 1e-9), 0.0, 1.0) + 0.3 * noise[0]
    omega_1 = 120.0 + 0.15 * noise[1]
    return Measurement("own", time, T_mot, omega_1, omega_1, None, None, None, None, {}, (), {})


@pytest.mark.parametrize("rise", [0.0, 0.15])
def test_a_step_is_found_where_it_begins(rise: float) -> None:
    step = tip(recording(rise=rise))
    assert step.T_0 == pytest.approx(-10.0, abs=0.2)
    assert step.omega_0 == pytest.approx(120.0, abs=0.1)
    assert np.interp(0.15, step.time, step.T_mot) == pytest.approx(-10.0, abs=2.0)
    assert np.interp(0.22 + rise, step.time, step.T_mot) == pytest.approx(70.0, abs=2.0)
    assert step.reversal


def test_a_torque_that_keeps_its_sign_crosses_no_gap() -> None:
    assert not tip(recording(before=10.0)).reversal
    assert tip(recording(before=10.0, height=-80.0)).reversal


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"height": 0.0}, "own: the torque has no step beyond its noise"),
        ({"at": 0.1}, "own: the torque has no step beyond its noise that begins after 0.2 s"),
        ({"until": 1.4}, "own: the step at 1 s needs 0.2 s before and 0.5 s after it"),
    ],
)
def test_what_cannot_be_used_is_refused(given: dict[str, float], message: str) -> None:
    with pytest.raises(RecordingError) as refused:
        tip(recording(**given))
    assert str(refused.value).startswith(message)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("plant", "known"),
    [
        ("TwoMassDriveline", {}),
        ("ValidationVehicle", {}),
        ("ValidationVehicle", {"C": CAR["C"], "phi_B": CAR["phi_B"]}),
    ],
    ids=["design model", "vehicle", "known before"],
)
def test_both_are_found_within_their_intervals(plant: str, known: dict[str, float], native: Path) -> None:
    settings = Settings(folder=native.parent, build="native")
    found = identify_step(recorded(plant, CAR, "tipin15", 3, settings), {"m": 1600.0, "J_2": 0.36, **known}, settings)
    assert found.plant == plant
    for name, most in (("C", 0.03), ("phi_B", 0.1)):
        off = abs(np.log(found.values[name] / CAR[name]))
        assert off < min(most, found.halves[name])
        assert found.halves[name] < 0.3


@pytest.mark.slow
def test_a_gap_that_is_not_there_is_not_told(native: Path) -> None:
    settings = Settings(folder=native.parent, build="native")
    found = identify_step(recorded("TwoMassDriveline", {**CAR, "phi_B": 0.0}, "tipin15", 3, settings), CAR, settings)
    assert found.halves["C"] < WIDEST < found.halves["phi_B"]
    assert "phi_B: not told, in rad it is anything from " in "\n".join(_lines(found))


@pytest.mark.slow
def test_a_vehicle_file_gets_what_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sheet, car = tmp_path / "sheet.toml", tmp_path / "car.toml"
    sheet.write_text("m = 1600\nfrequency = 7.0\n", encoding="utf-8")
    signals = tmp_path / "TwoMassDriveline_tipin0_off.csv"
    options = ["--control", "off", "--manoeuvre", "tipin0", "--quiet", "--output", str(tmp_path)]
    assert main(["simulate", *options, "--set", "plant.m=1600"]) == 0
    identify = ["identify", str(signals), "--step", "--vehicle", str(sheet), "--output", str(car)]
    assert main(identify) == 0
    assert "phi_B: not told, as the torque does not change its sign" in capsys.readouterr().out
    entries = read_vehicle(car)
    assert entries.keys() == {"m", "C"}
    assert entries["C"] == pytest.approx(117.4, rel=0.03)
    assert main([*identify, "--free", "J_1"]) == 2
    assert capsys.readouterr().err == "driveline identify: --step gives C and phi_B alone: leave --free out\n"
