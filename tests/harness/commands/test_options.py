"""What the shared options take and what they refuse."""

import os
import subprocess
import sys
from argparse import ArgumentTypeError, Namespace
from shutil import copytree, ignore_patterns

import pytest

from driveline.fmus.building.options import file as a_file
from driveline.fmus.building.options import folder, output_folder
from driveline.fmus.building.parameter_files import seeds
from driveline.fmus.catalogue import FMUS
from driveline.harness.base.errors import DrivelineError
from driveline.harness.commands.cli import parser
from driveline.harness.commands.options import assignment, figure_options, megabytes, seconds, seed, window
from driveline.harness.commands.recording_options import of_recording
from driveline.harness.loop.places import BUILD
from driveline.harness.views.figure_options import FigureOptions
from driveline.models.block.declaration import Integer, variables
from tests import ROOT


@pytest.mark.parametrize(
    ("text", "pair"),
    [
        ("plant.J_1=0.06", ("plant.J_1", 0.06)),
        (" motor.g_T = 1e-2 ", ("motor.g_T", 0.01)),
        ("controller.enable=True", ("controller.enable", 1.0)),
        ("plant.recorded_load=false", ("plant.recorded_load", 0.0)),
        ("plant.tyre.c=2", ("plant.tyre.c", 2.0)),
    ],
)
def test_an_assignment_has_a_name_and_a_number(text, pair):
    assert assignment(text) == pair


@pytest.mark.parametrize(
    "text", ["", "plant.J_1", "J_1=3", "plant.=3", ".J_1=3", "plant.J_1=", "plant.J_1=heavy", "plant.m=1_000"]
)
def test_what_is_no_assignment_is_answered_with_one(text):
    with pytest.raises(ArgumentTypeError, match=r"plant\.J_1=0\.06"):
        assignment(text)


@pytest.mark.parametrize("text", ["controller.k_d@2.0", "controller.k_d@2.0=", "controller.k_d@2.0=more"])
def test_a_change_without_a_value_is_answered_with_one(text):
    with pytest.raises(ArgumentTypeError, match=r"INSTANCE\.PARAMETER@TIME=VALUE, as controller\.k_d@2\.0=1\.5"):
        assignment(text)


@pytest.mark.parametrize("value", ["nan", "inf", "-inf"])
def test_a_parameter_is_finite(value):
    with pytest.raises(ArgumentTypeError, match="finite"):
        assignment(f"plant.m={value}")


@pytest.mark.parametrize(
    ("text", "times"),
    [("1,2.5", (1.0, 2.5)), (" 0.9 , 1e1 ", (0.9, 10.0)), ("-1,1", (-1.0, 1.0)), ("1,1.01", (1, 1.01))],
)
def test_a_window_is_from_one_time_to_a_later_one(text, times):
    assert window(text) == times


@pytest.mark.parametrize(
    "text", ["", "1", "1,", ",1", "2,1", "1,1", "1,1.009", "1,2,3", "a,b", "nan,2", "1,inf", "1;2"]
)
def test_what_is_no_window_is_answered_with_one(text):
    with pytest.raises(ArgumentTypeError, match=r"is not of the form 1\.0,2\.5"):
        window(text)


def test_a_window_shows_something_of_every_run():
    def options_for(start, end):
        return figure_options(
            Namespace(window=(start, end), figures=None), "", ("tipin15", 0.0, 6.0), ("drive", 0.0, 20.0)
        )

    assert options_for(5.99, 9.0).clipped(0.0, 6.0) == (5.99, 6.0)
    assert options_for(-1.0, 0.1).clipped(0.0, 6.0) == (0.0, 0.1)
    for start, end in ((6.0, 9.0), (-1.0, 0.0), (30.0, 40.0)):
        with pytest.raises(DrivelineError, match=f"--window {start:g},{end:g}: tipin15 is from 0 to 6 s"):
            options_for(start, end)


def test_figures_are_of_the_kinds_that_are_asked_for_each_once():
    assert figure_options(Namespace(window=None, figures=["svg", "png", "svg"]), "said") == FigureOptions(
        "said", None, ("svg", "png")
    )
    assert figure_options(Namespace(window=None, figures=None), "") == FigureOptions("", None, ("png", "pdf"))


def test_a_seed_is_what_the_blocks_declare():
    least, most = seeds()
    for name in ("MotorTorqueLoop", "WheelSpeedCan"):
        declared = next(v.declaration for v in variables(FMUS[name].block.Parameters) if v.name == "seed")
        assert isinstance(declared, Integer)
        assert (declared.minimum, declared.maximum) == (least, most)
    assert [seed(str(number)) for number in (least, most)] == [least, most]
    for text in (str(least - 1), str(most + 1), "", "one", "1.0", "1_000", "+1", " 1", "\u0661"):
        with pytest.raises(ArgumentTypeError, match=f"whole number from {least} to {most}$"):
            seed(text)


def test_a_time_is_above_zero_and_finite():
    assert seconds("1e-9") == 1e-9
    for text in ("0", "-0.001", "nan", "inf", "", "1 s", "1_0", "\u0661", "infinity"):
        with pytest.raises(ArgumentTypeError, match="not a time above 0 s"):
            seconds(text)


def test_a_size_is_finite_in_bytes():
    assert megabytes("1e302") == round(1e308)
    assert [megabytes(text) for text in ("1000", "0.29", "1e-6", "1e-7")] == [10**9, 290_000, 1, 1]
    for text in ("1e303", "0", "inf"):
        with pytest.raises(ArgumentTypeError, match="not a size above 0 MB"):
            megabytes(text)


@pytest.mark.parametrize("take", [assignment, seed, seconds, megabytes])
def test_what_is_long_or_strange_is_not_repeated_as_it_is(take):
    for text in ("9" * 5000, "\x1b[31m9"):
        with pytest.raises(ArgumentTypeError) as refusal:
            take(text)
        assert len(str(refusal.value)) < 200
        assert str(refusal.value).isprintable()


def test_a_folder_is_no_file(tmp_path):
    file = tmp_path / "signals.csv"
    assert folder(str(file)) == file
    file.touch()
    with pytest.raises(ArgumentTypeError, match="is a file"):
        folder(str(file))
    assert folder(str(tmp_path)) == tmp_path


@pytest.mark.parametrize("take", [folder, output_folder, a_file])
def test_a_name_that_is_too_long_is_refused(take):
    with pytest.raises(ArgumentTypeError, match=r"^File name too long$"):
        take("a" * 5000)


def test_a_folder_for_results_is_tried_and_nothing_is_left_of_it(tmp_path):
    assert output_folder(str(tmp_path / "new" / "results")) == tmp_path / "new" / "results"
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "file").touch()
    for text in ("/proc/results", str(tmp_path / "file" / "results")):
        with pytest.raises(ArgumentTypeError, match="cannot be written to"):
            output_folder(text)


def test_a_file_is_no_folder(tmp_path):
    assert a_file(str(tmp_path / "gains.toml")) == tmp_path / "gains.toml"
    with pytest.raises(ArgumentTypeError, match="is a folder"):
        a_file(str(tmp_path))
    with pytest.raises(ArgumentTypeError, match="empty"):
        a_file("")


def test_fmus_are_in_the_checkout_or_else_in_the_working_directory(tmp_path):
    assert BUILD == ROOT / "build"
    package, left_out = tmp_path / "site/driveline", ignore_patterns("__pycache__", "*.so", "models", "fmus", "harness")
    copytree(ROOT / "driveline", package, ignore=left_out)
    for name in ("fmus", "models", "harness"):
        copytree(ROOT / name, package / name, ignore=ignore_patterns("__pycache__", "*.so"))
    statement = "from driveline.harness.loop.places import BUILD; print(BUILD)"
    done = subprocess.run(
        [sys.executable, "-c", statement],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(tmp_path / "site")},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.strip() == "build"


def test_other_samples_columns_names_or_frames_make_another_run(tmp_path):
    file, empty = tmp_path / "names.toml", tmp_path / "empty.csv"
    empty.touch()
    usual = {"recording": empty, "columns": [], "databases": [], "aliases": []}
    seen = [of_recording(Namespace(**usual | {"columns": [("v", "speed")]})), of_recording(Namespace(**usual))]
    assert seen[1].keys() == {"recording", "columns"}
    for text in ("v = ['a']", "v = ['b']"):
        file.write_text(text)
        for changed in ({"recording": file}, {"databases": [file]}, {"aliases": [file]}):
            seen.append(of_recording(Namespace(**usual | changed)))
    assert len({str(each) for each in seen}) == 8


@pytest.mark.parametrize(("command", "most"), [("faults", 1_000_000), ("robustness", 100_000)])
@pytest.mark.parametrize("option", ["--case", "--cases"])
def test_cases_have_numbers_from_one_to_the_most(command, most, option, capsys):
    for number in (1, most):
        assert number in vars(parser().parse_args([command, option, str(number)])).values()
    for number in (0, most + 1):
        with pytest.raises(SystemExit):
            parser().parse_args([command, option, str(number)])
        assert f"argument {option}: '{number}' is not a whole number from 1 to {most}" in capsys.readouterr().err
