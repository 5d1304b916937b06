"""What is wrong with the options is said first, and only then what is in the folder for the results."""

import shutil
from pathlib import Path

import pytest

from driveline.harness.commands.cli import main
from driveline.harness.manoeuvres.catalogue import TOWN_DRIVE
from tests.harness.commands import Capsys

FIRST = {
    "simulate": "TwoMassDriveline_tipin15_DampingController.csv",
    "record": "TwoMassDriveline_prbs_off.csv",
    "replay": f"{TOWN_DRIVE.stem}_metrics.csv",
    "faults": "faults.csv",
}
"""A file of the results of each command."""


@pytest.fixture
def message(both_built: Path, tmp_path: Path, capsys: Capsys):
    """What a command says that must not run, into a folder with results of nobody knows which run."""
    folder = tmp_path / "results"
    folder.mkdir()

    def message(command: str, *options: str) -> str:
        (folder / FIRST[command]).touch()
        file = [str(TOWN_DRIVE)] if command == "replay" else []
        code = main([command, *file, "--fmus", str(both_built), "--output", str(folder), "--quiet", *options])
        assert code == 2
        assert [path.name for path in folder.iterdir()] == [FIRST[command]]
        return capsys.readouterr().err

    return message


@pytest.mark.parametrize("command", FIRST)
def test_a_folder_with_other_results_is_named(message, command: str) -> None:
    assert f"{FIRST[command]} is there" in message(command)


@pytest.mark.parametrize(
    ("command", "option", "value", "reason"),
    [
        ("simulate", "--step", "7", "a step of 7 s in a run of 6 s: steps must be longer than 0 s and not longer"),
        ("simulate", "--step", "1e-300", "a step of 1e-300 s in a run of 6 s: these are too many steps"),
        ("record", "--duration", "1e-9", "a step of 0.001 s in a run of 1e-09 s: steps must be longer than 0 s and"),
        ("record", "--duration", "1e300", "a step of 0.001 s in a run of 1e+300 s: these are too many steps"),
        ("record", "--speed", "360", "plant.v_0 = 100: TwoMassDriveline.fmu takes 0 to 70 m/s"),
        ("replay", "--held", "0.0009", "a demand that is held for 0.0009 s: it must be 0.001 s or more"),
    ],
)
def test_an_option_that_no_run_can_have_is_named_before_the_folder(message, command, option, value, reason) -> None:
    (line,) = message(command, option, value).splitlines()
    assert line.startswith(f"driveline {command}: {reason}")


def test_two_plants_of_one_name_are_named_before_the_folder(message, native: Path, tmp_path: Path) -> None:
    plants = []
    for name in ("mine", "theirs"):
        (tmp_path / name).mkdir()
        plants += ["--plant", shutil.copy(native / "TwoMassDriveline.fmu", tmp_path / name)]
    assert "two plants are called TwoMassDriveline" in message("faults", *plants)


@pytest.mark.parametrize("command", ["replay", "identify"])
def test_what_is_no_file_is_refused_before_it_is_read(command: str, tmp_path: Path, capsys: Capsys) -> None:
    """A pipe that nobody writes to, or a device that gives without end, as a folder here."""
    assert main([command, str(tmp_path)]) == 2
    assert capsys.readouterr().err == f"driveline {command}: {tmp_path} is a folder; a file is needed\n"
