"""--manoeuvre with a file."""

import csv
import json

import pytest

from driveline.harness.commands.cli import main

TIPIN = """\
duration = 3.0
v_0 = "15 km/h"
T_driver = [{ kind = "constant", value = -12 }, { kind = "step", at = 1, height = 112 }]
"""


@pytest.fixture
def tipin(tmp_path):
    path = tmp_path / "tip.toml"
    path.write_text(TIPIN, encoding="utf-8")
    return path


def test_a_run_says_which_file_it_drove(native, tmp_path, tipin, capsys):
    command = ["simulate", "--manoeuvre", str(tipin), "--fmus", str(native.parent), "--output", str(tmp_path / "out")]
    assert main(command) == 0
    record = json.loads((tmp_path / "out" / "TwoMassDriveline_tip_on.json").read_text())
    assert str(tipin) in record["inputs"]
    assert main(command) == 0, "the same again"
    tipin.write_text(TIPIN.replace("112", "100"), encoding="utf-8")
    assert main(command) == 2
    assert "is of another run (manoeuvre_files tip:" in capsys.readouterr().err


@pytest.mark.slow
def test_a_comparison_measures_a_step_of_a_file_as_one_of_the_catalogue(native, tmp_path, tipin):
    tipin.write_text(TIPIN.replace("3.0", "6.0"), encoding="utf-8")
    pulse = tmp_path / "pulse.toml"
    pulse.write_text(
        'duration = 3\nv_0 = 5\nT_driver = [{ kind = "pulse", begin = 1, end = 2, height = 50 }]', encoding="utf-8"
    )
    names = [x for name in (str(tipin), "tipin15", str(pulse)) for x in ("--manoeuvre", name)]
    command = ["compare", *names, "--plant", "TwoMassDriveline", "--fmus", str(native.parent), "--quiet"]
    assert main([*command, "--figures", "png", "--output", str(tmp_path / "out")]) == 0
    with (tmp_path / "out" / "metrics.csv").open(encoding="utf-8", newline="") as file:
        rows = {(row["manoeuvre"], row["control"]): row for row in csv.DictReader(file)}
    for control in "01":
        ours, theirs = (
            {k: v for k, v in rows[name, control].items() if k != "manoeuvre"} for name in ("tipin15", "tip")
        )
        assert ours == theirs
        assert rows["pulse", control]["settling_time_s"] == ""
        assert "no step" in rows["pulse", control]["absent"]
        assert float(rows["pulse", control]["gear_torque_rms_N_m"]) > 0.0
    for name in ("tip", "pulse"):
        assert (tmp_path / "out" / f"TwoMassDriveline_{name}.png").is_file()


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ("T_driver = 181", "T_driver = 181 N.m at 0 s: the motor makes -180 to 180 N.m (motor.T_max)"),
        ("T_brake = -1", "T_brake = -1 N.m at 0 s: TwoMassDriveline.fmu takes 0 to 20000 N.m"),
        ("slope = [{ kind = 'step', at = 1, height = 0.51 }]", "slope = 0.51 rad at 1 s: TwoMassDriveline.fmu takes"),
        ("v_0 = 71", "v_0 = 71 m/s: TwoMassDriveline.fmu takes 0 to 70 m/s"),
    ],
)
@pytest.mark.parametrize("command", ["simulate", "compare"])
def test_what_the_loop_does_not_take_is_said_before_it_runs(native, tmp_path, capsys, command, entries, message):
    path = tmp_path / "beyond.toml"
    path.write_text(f"duration = 2\n{entries}\n", encoding="utf-8")
    out = tmp_path / "out"
    options = ["--plant", "TwoMassDriveline", "--manoeuvre", str(path), "--fmus", str(native.parent)]
    assert main([command, *options, "--output", str(out)]) == 2
    assert f"driveline {command}: {path}: {message}" in capsys.readouterr().err
    assert not [file for file in out.rglob("*") if file.is_file()]


def test_what_the_loop_just_takes_is_driven(native, tmp_path):
    path = tmp_path / "just.toml"
    path.write_text("duration = 0.01\nT_driver = 180\nT_brake = 20000\nslope = 0.5\n", encoding="utf-8")
    assert main(["simulate", "--manoeuvre", str(path), "--fmus", str(native.parent), "--output", str(tmp_path)]) == 0


@pytest.mark.parametrize("words", [["compare", "--manoeuvre", "tipin15"], ["explore"]])
def test_two_manoeuvres_of_one_name_are_refused(native, tmp_path, capsys, words):
    path = tmp_path / "tipin15.toml"
    path.write_text(TIPIN, encoding="utf-8")
    assert main([*words, "--manoeuvre", str(path), "--fmus", str(native.parent)]) == 2
    assert "two manoeuvres are called tipin15; rename the file of one" in capsys.readouterr().err
