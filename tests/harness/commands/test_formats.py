"""--format and --manoeuvre with a file: runs in the formats of other tools, and manoeuvres of a user."""

import json

import numpy as np
import pytest
from fmutesting.slow import slow

from driveline.harness.commands.cli import main
from driveline.harness.views.signals_file import FORMATS
from driverecords.channels import Channels
from driverecords.drive import read_drive
from driverecords.measurement import read_measurement

pytestmark = pytest.mark.usefixtures("read_here")

OTHERS = [name for name in FORMATS if name != "csv"]


@pytest.fixture(scope="module")
def driven(native, tmp_path_factory):
    """The same run in every format; the folder has one for each."""
    folder = tmp_path_factory.mktemp("formats")
    for name in FORMATS:
        options = ["--fmus", str(native.parent), "--output", str(folder / name), "--format", name, "--quiet"]
        assert main(["simulate", "--manoeuvre", "prbs15", *options]) == 0
        assert main(["record", "--duration", "4", *options]) == 0
    return folder


def path(driven, name, stem="TwoMassDriveline_prbs15_DampingController"):
    return driven / name / f"{stem}{FORMATS[name].ending}"


@pytest.mark.parametrize("name", OTHERS)
def test_a_run_is_the_same_drive_in_every_format(driven, name):
    expected, found = read_drive(path(driven, "csv")), read_drive(path(driven, name))
    for quantity in ("time", "v", "T_mot"):
        np.testing.assert_array_equal(getattr(found, quantity), getattr(expected, quantity))


@pytest.mark.parametrize("name", slow(OTHERS, but=["mf4"]))
def test_a_recorded_test_drive_is_the_same_measurement_in_every_format(driven, name):
    stem = "TwoMassDriveline_prbs_off"
    expected, found = (read_measurement(path(driven, one, stem), 9.7, 0.3) for one in ("csv", name))
    for quantity in ("time", "T_mot", "omega_1", "omega_2", "valid", "counter", "T_load", "T_ref"):
        np.testing.assert_array_equal(getattr(found, quantity), getattr(expected, quantity), err_msg=quantity)


@pytest.mark.slow
def test_rides_and_comparisons_are_written_in_the_format(driven, native, tmp_path):
    name = "mf4"
    recording, ending = path(driven, name), FORMATS[name].ending
    options = ["--plant", "TwoMassDriveline", "--fmus", str(native.parent), "--quiet", "--format", name]
    assert main(["replay", str(recording), *options, "--output", str(tmp_path)]) == 0
    rides = [tmp_path / f"{recording.stem}_{what}{ending}" for what in ("off", "DampingController")]
    record = json.loads((tmp_path / f"{recording.stem}.json").read_text())
    assert {ride.name for ride in rides} <= set(record["files"])
    assert main(["compare", "--manoeuvre", "prbs15", *options, "--output", str(tmp_path)]) == 0
    stems = ("TwoMassDriveline_prbs15_off", "TwoMassDriveline_prbs15_DampingController")
    runs = {tmp_path / "runs" / f"{stem}{kind}" for stem in stems for kind in (ending, ".json")}
    assert set((tmp_path / "runs").iterdir()) == runs
    for file in (*rides, tmp_path / "runs" / f"{stems[0]}{ending}"):
        assert Channels(file).read("v")["v"].unit == "m/s"


def test_another_format_is_another_run(driven, native, capsys):
    options = ["--manoeuvre", "prbs15", "--fmus", str(native.parent), "--output", str(driven / "csv")]
    assert main(["simulate", *options, "--format", "mf4"]) == 2
    assert "is of another run (format: not set there, mf4 here)" in capsys.readouterr().err


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
    record = json.loads((tmp_path / "out" / "TwoMassDriveline_tip_DampingController.json").read_text())
    assert str(tipin) in record["inputs"]
    assert main(command) == 0, "the same again"
    tipin.write_text(TIPIN.replace("112", "100"), encoding="utf-8")
    assert main(command) == 2
    assert "is of another run (manoeuvre_files tip:" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ("T_driver = 181", "T_driver = 181 N.m at 0 s: the motor makes -180 to 180 N.m (motor.T_max)"),
        ("T_brake = -1", "T_brake = -1 N.m at 0 s: TwoMassDriveline.fmu takes 0 to 20000 N.m"),
        ("slope = [{ kind = 'step', at = 1, height = 0.51 }]", "slope = 0.51 rad at 1 s: TwoMassDriveline.fmu takes"),
        ("v_0 = 71", "v_0 = 71 m/s: TwoMassDriveline.fmu takes 0 to 70 m/s"),
    ],
)
def test_what_the_loop_does_not_take_is_said_before_it_runs(native, tmp_path, capsys, entries, message):
    path = tmp_path / "beyond.toml"
    path.write_text(f"duration = 2\n{entries}\n", encoding="utf-8")
    out = tmp_path / "out"
    options = ["--plant", "TwoMassDriveline", "--manoeuvre", str(path), "--fmus", str(native.parent)]
    command = "compare" if entries.startswith("v_0") else "simulate"
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
