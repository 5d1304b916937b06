"""`driveline design`: gains for a car, printed or written."""

import tomllib
from pathlib import Path

import pytest

from driveline.fmus.building.parameter_files import read_parameters, read_vehicle
from driveline.harness.commands.cli import main
from driveline.harness.design.design import design
from tests import ROOT
from tests.harness.commands import Capsys

VAN = ROOT / "examples" / "cars" / "van.toml"
OF_VAN = ["design", "--vehicle", str(VAN)]


def test_the_gains_of_a_car_are_printed_with_units_and_meaning_or_written(tmp_path: Path, capsys: Capsys) -> None:
    assert main(OF_VAN) == 0
    text, path = capsys.readouterr().out, tmp_path / "new" / "gains.toml"
    first, second, *lines = text.splitlines()
    assert first.startswith("# Gains of the DampingController for van.toml, by `driveline design` (driveline-damping")
    assert second == "# Drive train: 6.97 Hz; damped: 8.15 Hz, damping ratio 0.60."
    assert tomllib.loads(text) == pytest.approx(design(read_vehicle(VAN)), rel=1e-5)
    assert any(line.endswith("# N.m.s/rad, damping over the speed difference") for line in lines)
    assert main([*OF_VAN, "--output", str(path)]) == 0
    assert capsys.readouterr().out == f"gains: {path}\n"
    assert read_parameters(path) == tomllib.loads(text)
    assert [file.name for file in path.parent.iterdir()] == ["gains.toml"]


def test_limits_of_a_user_are_kept(tmp_path: Path, capsys: Capsys) -> None:
    limits, more = tmp_path / "limits.toml", tmp_path / "more.toml"
    limits.write_text("T_take_max = 120\nT_add_max = 500\n", encoding="utf-8")
    assert main([*OF_VAN, "--parameters", str(limits)]) == 0
    asked = design(read_vehicle(VAN))
    assert tomllib.loads(capsys.readouterr().out) == pytest.approx(asked | {"T_take_max": 120.0}, rel=1e-5)
    more.write_text("k_d = 3\n", encoding="utf-8")
    assert main(["design", "--parameters", str(more)]) == 2
    refusal = f"driveline design: {more}: a file of limits (T_take_max and T_add_max) has no parameter k_d\n"
    assert capsys.readouterr().err == refusal
    assert main(["design", "--parameters", str(limits), "--search", str(tmp_path / "search")]) == 2
    assert "leave it out, or --search" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["T_take_max", "T_add_max"])
def test_a_limit_may_be_small_but_not_zero(name: str, tmp_path: Path, capsys: Capsys) -> None:
    limits = tmp_path / "limits.toml"
    limits.write_text(f"{name} = 1e-3\n", encoding="utf-8")
    assert main(["design", "--parameters", str(limits)]) == 0
    assert tomllib.loads(capsys.readouterr().out)[name] == 1e-3
    limits.write_text(f"{name} = 0\n", encoding="utf-8")
    assert main(["design", "--parameters", str(limits)]) == 2
    assert capsys.readouterr().err == f"driveline design: {limits}: {name} = 0: a limit must be above 0 N.m\n"


def test_nothing_depends_on_the_working_directory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capsys
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["design"]) == 0
    stored = (ROOT / "models" / "controller" / "gains.toml").read_text(encoding="utf-8")
    assert capsys.readouterr().out == stored
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("J1 = 0.09\n", "line 1: J1 is not known"),
        ("T_cyc = 0.2\n", "T_age would be 0.113; the controller takes"),
        ("tau = 0.06\n", "the motor is too slow for this car (tau = 0.06 s, drive train 7.46 Hz): the damping ratio"),
    ],
)
def test_a_car_without_a_controller_is_answered_with_exit_code_2(
    tmp_path: Path, capsys: Capsys, text: str, message: str
) -> None:
    car, gains = tmp_path / "car.toml", tmp_path / "gains.toml"
    car.write_text(text, encoding="utf-8")
    assert main(["design", "--vehicle", str(car), "--output", str(gains)]) == 2
    assert message in capsys.readouterr().err
    assert not gains.exists()


def test_gains_of_another_car_are_not_replaced_unasked(tmp_path: Path, capsys: Capsys) -> None:
    path = tmp_path / "gains.toml"
    of_van = [*OF_VAN, "--output", str(path)]
    assert [main(of_van), main(of_van)] == [0, 0]
    before = path.read_bytes()
    assert main(["design", "--output", str(path)]) == 2
    assert f"{path} is there with another content" in capsys.readouterr().err
    assert path.read_bytes() == before
    assert main(["design", "--output", str(path), "--replace"]) == 0
    assert path.read_bytes() != before
