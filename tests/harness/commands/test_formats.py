"""--format: runs in the formats of other tools, and what our own commands make of them."""

import json

import numpy as np
import pytest

from driveline.harness.commands.cli import main
from driveline.harness.recordings.drive import read_drive
from driveline.harness.recordings.measurement import read_measurement
from driveline.harness.views.signals_file import FORMATS
from tests.slow import slow

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


def path(driven, name, stem="TwoMassDriveline_prbs15_on"):
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


@pytest.mark.parametrize("name", slow(OTHERS, but=["mf4"]))
@pytest.mark.slow
def test_a_run_in_another_format_can_be_driven_again(driven, name, native, tmp_path):
    options = ["--fmus", str(native.parent), "--output", str(tmp_path), "--quiet", "--format", name]
    assert main(["replay", str(path(driven, name)), "--plant", "TwoMassDriveline", *options]) == 0
    rides = [
        tmp_path / f"{path(driven, name).stem}_{what}{FORMATS[name].ending}" for what in ("off", "DampingController")
    ]
    record = json.loads((tmp_path / f"{path(driven, name).stem}.json").read_text())
    assert {ride.name for ride in rides} <= set(record["files"])
    assert all(read_drive_speed(ride) for ride in rides)


def read_drive_speed(ride):
    from driveline.harness.recordings.channels import Channels

    return Channels(ride).read("v")["v"].unit == "m/s"


@pytest.mark.parametrize("name", slow(OTHERS, but=["mf4"]))
@pytest.mark.slow
def test_a_comparison_writes_its_runs_in_the_format(native, tmp_path, name):
    options = ["--plant", "TwoMassDriveline", "--manoeuvre", "prbs15", "--fmus", str(native.parent), "--quiet"]
    assert main(["compare", *options, "--output", str(tmp_path), "--format", name]) == 0
    files = {file.name for file in (tmp_path / "runs").iterdir()}
    stems = ("TwoMassDriveline_prbs15_off", "TwoMassDriveline_prbs15_on")
    assert files == {f"{stem}{ending}" for stem in stems for ending in (FORMATS[name].ending, ".json")}
    assert read_drive_speed(tmp_path / "runs" / f"{stems[0]}{FORMATS[name].ending}")


def test_another_format_is_another_run(driven, native, capsys):
    options = ["--manoeuvre", "prbs15", "--fmus", str(native.parent), "--output", str(driven / "csv")]
    assert main(["simulate", *options, "--format", "mf4"]) == 2
    assert "is of another run (format: not set there, mf4 here)" in capsys.readouterr().err
