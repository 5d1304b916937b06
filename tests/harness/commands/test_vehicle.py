"""A vehicle file meets an FMU that somebody else wrote."""

from pathlib import Path

import numpy as np
import pytest

from driveline.harness.commands.cli import main
from tests.foreign import build_car


@pytest.mark.slow
def test_a_vehicle_file_reaches_a_parameter_in_another_unit_once_it_is_mapped(
    both_built: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    heavy = tmp_path / "heavy.toml"
    heavy.write_text("m = 2000.0\n")
    plain, theirs = (
        build_car(tmp_path / name, m=("m", unit, factor)) for name, unit, factor in (("si", "kg", 1.0), ("t", "t", 1e3))
    )
    options = ["simulate", "--vehicle", str(heavy), "--fmus", str(both_built), "--quiet"]
    assert main([*options, "--plant", str(theirs), "--output", str(tmp_path)]) == 2
    assert "plant.m is in t; the file gives it in kg (--map plant.m=m converts it)" in capsys.readouterr().err
    for name, plant, mapped in (("si", plain, []), ("t", theirs, ["--map", "plant.m=m"])):
        assert main([*options, "--plant", str(plant), *mapped, "--output", str(tmp_path / name)]) == 0
    runs = [np.genfromtxt(next((tmp_path / name).glob("*.csv")), delimiter=",", names=True) for name in ("si", "t")]
    np.testing.assert_allclose(runs[1]["plantv"], runs[0]["plantv"], rtol=1e-9)


def test_a_parameter_of_the_same_name_and_another_dimension_is_refused_even_if_mapped(
    both_built: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    heavy = tmp_path / "heavy.toml"
    heavy.write_text("m = 2000.0\n")
    plant = build_car(tmp_path / "metres", m=("m", "m", 1.0))
    options = ["simulate", "--vehicle", str(heavy), "--fmus", str(both_built), "--plant", str(plant)]
    for mapped in ([], ["--map", "plant.m=m"]):
        assert main([*options, *mapped, "--output", str(tmp_path)]) == 2
        assert "plant.m is in m, which does not convert into kg, the unit of the file" in capsys.readouterr().err


@pytest.mark.slow
def test_what_a_vehicle_file_does_not_reach_is_said(
    both_built: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture
) -> None:
    """Somebody else's plant without J_1, whatever its name, keeps its own, while the controller's model takes that of
    the file."""
    car, gains = tmp_path / "car.toml", tmp_path / "gains.toml"
    car.write_text("J_1 = 0.06\n")
    gains.write_text("k_d = 2.0\n")
    theirs = build_car(tmp_path / "theirs", m=("m", "kg", 1.0)).rename(tmp_path / "TwoMassDriveline.fmu")
    options = ["simulate", "--vehicle", str(car), "--fmus", str(both_built), "--quiet", "--output", str(tmp_path)]
    assert main([*options, "--plant", str(theirs)]) == 0
    assert "has no parameter J_1: the file reaches the other blocks alone" in caplog.text
    assert "the gains of the default car" in caplog.text
    caplog.clear()
    assert main([*options, "--parameters", str(gains), "--replace"]) == 0
    assert caplog.text == ""
