"""What the shared options take and what they refuse, and what is said of them."""

from argparse import ArgumentTypeError
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from driveline.fmus.building.parameter_files import seeds
from driveline.fmus.catalogue import FMUS
from driveline.harness.commands.options import Figures, assignment, seed, window
from driveline.harness.commands.recorded import Recorded
from driveline.harness.commands.settings import caption
from driveline.harness.studies.compare.compare import Case
from driveline.harness.views.figure_options import FigureOptions
from fmublocks.block.declaration import Integer, variables
from tests.harness.commands import Capsys, given
from toolground.argument_types import file, folder, megabytes, output_folder, seconds, share
from toolground.errors import UserError
from toolground.printing import JsonPrinting, Printing

Parse = Callable[[str], Any]


@pytest.mark.parametrize(
    ("parse", "text", "value"),
    [
        (assignment, "plant.J_1=0.06", ("plant.J_1", 0.06)),
        (assignment, " motor.g_T = 1e-2 ", ("motor.g_T", 0.01)),
        (assignment, "controller.enable=True", ("controller.enable", 1.0)),
        (assignment, "plant.recorded_load=false", ("plant.recorded_load", 0.0)),
        (assignment, "plant.tyre.c=2", ("plant.tyre.c", 2.0)),
        (window, "1,2.5", (1.0, 2.5)),
        (window, " 0.9 , 1e1 ", (0.9, 10.0)),
        (window, "-1,1", (-1.0, 1.0)),
        (window, "1,1.01", (1.0, 1.01)),
        (seconds, "1e-9", 1e-9),
        (share, "0", 0.0),
        (share, "1", 1.0),
        (megabytes, "1e302", round(1e308)),
        *zip([megabytes] * 4, ("1000", "0.29", "1e-6", "1e-7"), (10**9, 290_000, 1, 1), strict=True),
    ],
)
def test_what_is_typed_becomes_a_value(parse: Parse, text: str, value: Any) -> None:
    assert parse(text) == value


@pytest.mark.parametrize(
    ("parse", "texts", "reason"),
    [
        (
            assignment,
            ("", "plant.J_1", "J_1=3", "plant.=3", ".J_1=3", "plant.J_1=", "plant.J_1=heavy", "plant.m=1_000"),
            r"plant\.J_1=0\.06",
        ),
        (
            assignment,
            ("controller.k_d@2.0", "controller.k_d@2.0=", "controller.k_d@2.0=more"),
            r"INSTANCE\.PARAMETER@TIME=VALUE, as controller\.k_d@2\.0=1\.5",
        ),
        (assignment, ("plant.m=nan", "plant.m=inf", "plant.m=-inf"), "a parameter is a finite number"),
        (
            window,
            ("", "1", "1,", ",1", "2,1", "1,1", "1,1.009", "1,2,3", "a,b", "nan,2", "1,inf", "1;2"),
            r"is not of the form 1\.0,2\.5",
        ),
        (seconds, ("0", "-0.001", "nan", "inf", "", "1 s", "1_0", "\u0661", "infinity"), "not a time above 0 s"),
        (share, ("-0.001", "1.001", "nan"), "not a number from 0 to 1"),
        (megabytes, ("1e303", "0", "inf"), "not a size above 0 MB"),
    ],
)
def test_what_is_no_value_is_answered_with_one(parse: Parse, texts: tuple[str, ...], reason: str) -> None:
    for text in texts:
        with pytest.raises(ArgumentTypeError, match=reason):
            parse(text)


@pytest.mark.parametrize("parse", [assignment, seed, seconds, megabytes])
def test_what_is_long_or_strange_is_not_repeated_as_it_is(parse: Parse) -> None:
    for text in ("9" * 5000, "\x1b[31m9"):
        with pytest.raises(ArgumentTypeError) as refusal:
            parse(text)
        assert len(str(refusal.value)) < 200
        assert str(refusal.value).isprintable()


def test_a_seed_is_what_the_blocks_declare() -> None:
    least, most = seeds()
    for name in ("MotorTorqueLoop", "WheelSpeedCan"):
        declared = next(v.declaration for v in variables(FMUS[name].block.Parameters) if v.name == "seed")
        assert isinstance(declared, Integer)
        assert (declared.minimum, declared.maximum) == (least, most)
    assert [seed(str(number)) for number in (least, most)] == [least, most]
    for text in (str(least - 1), str(most + 1), "", "one", "1.0", "1_000", "+1", " 1", "\u0661"):
        with pytest.raises(ArgumentTypeError, match=f"whole number from {least} to {most}$"):
            seed(text)


def test_a_window_and_the_kinds_of_figures_are_those_that_are_asked_for() -> None:
    def options_for(start: float, end: float) -> FigureOptions:
        return Figures(window=(start, end)).options("", ("tipin15", 0.0, 6.0), ("drive", 0.0, 20.0))

    assert options_for(5.99, 9.0).clipped(0.0, 6.0) == (5.99, 6.0)
    assert options_for(-1.0, 0.1).clipped(0.0, 6.0) == (0.0, 0.1)
    for start, end in ((6.0, 9.0), (-1.0, 0.0), (30.0, 40.0)):
        with pytest.raises(UserError, match=f"--window {start:g},{end:g}: tipin15 is from 0 to 6 s"):
            options_for(start, end)
    asked = Figures(figures=("svg", "png", "svg"))
    assert asked.options("said") == FigureOptions("said", None, ("svg", "png"))
    assert Figures().options("") == FigureOptions("", None, ("png",))


def test_a_folder_is_no_file_a_file_no_folder_and_one_for_results_is_tried(tmp_path: Path) -> None:
    assert output_folder(str(tmp_path / "new" / "results")) == tmp_path / "new" / "results"
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "file").touch()
    for text in ("/proc/results", str(tmp_path / "file" / "results")):
        with pytest.raises(ArgumentTypeError, match="cannot be written to"):
            output_folder(text)
    one = tmp_path / "signals.csv"
    assert [take(str(one)) for take in (folder, file)] == [one, one]
    one.touch()
    for take, path, reason in ((folder, one, "is a file"), (file, tmp_path, "is a folder")):
        with pytest.raises(ArgumentTypeError, match=reason):
            take(str(path))
    assert folder(str(tmp_path)) == tmp_path


@pytest.mark.parametrize("take", [folder, output_folder, file])
def test_a_name_that_is_empty_or_too_long_is_refused(take: Parse) -> None:
    for name, reason in (("a" * 5000, "^File name too long$"), ("", "is empty$")):
        with pytest.raises(ArgumentTypeError, match=reason):
            take(name)


def test_other_samples_columns_names_or_frames_make_another_run(tmp_path: Path) -> None:
    names, empty = tmp_path / "names.toml", tmp_path / "empty.csv"
    empty.touch()
    usual = Recorded(recording=empty)
    seen = [replace(usual, column=(("v", "speed"),)).distinguishing, usual.distinguishing]
    assert seen[1].keys() == {"recording", "columns"}
    for text in ("v = ['a']", "v = ['b']"):
        names.write_text(text)
        for changed in ({"recording": names}, {"dbc": (names,)}, {"aliases": (names,)}):
            seen.append(replace(usual, **changed).distinguishing)  # type: ignore[arg-type]
    assert len({str(each) for each in seen}) == 8


@pytest.mark.parametrize(("command", "most"), [("faults", 1_000_000), ("robustness", 100_000)])
@pytest.mark.parametrize("option", ["case", "cases"])
def test_cases_have_numbers_from_one_to_the_most(command: str, most: int, option: str, capsys: Capsys) -> None:
    for number in (1, most):
        assert getattr(given(command, f"--{option}", str(number)), option) == number
    for number in (0, most + 1):
        with pytest.raises(SystemExit):
            given(command, f"--{option}", str(number))
        assert f"argument --{option}: '{number}' is not a whole number from 1 to {most}" in capsys.readouterr().err


RUNS = {"simulate": [], "compare": [], "replay": ["trip.csv"]}
BOTH = "--controller DampingController --controller mine.fmu"


@pytest.mark.parametrize(
    ("command", "options", "message"),
    [
        *((command, "", "") for command in RUNS),
        *((command, "--fmus /somewhere --build native --quiet", "") for command in RUNS),
        *((command, "--seed 3 --set plant.J_1=0.06", "--set plant.J_1=0.06 --seed 3") for command in RUNS),
        *(
            (command, "--vehicle van.toml --controller mine.fmu", "--controller mine.fmu --vehicle van.toml")
            for command in RUNS
        ),
        ("replay", BOTH, BOTH),
        ("replay", "--controller DampingController", ""),
        ("simulate", "--step 0.0005 --scheme jacobi", "--step 0.0005 --scheme jacobi"),
        ("simulate", "--map plant.v=speed", "--map plant.v=speed"),
    ],
)
def test_a_figure_says_what_was_set(command: str, options: str, message: str) -> None:
    assert caption(given(command, *RUNS[command], *options.split())) == message


def test_a_case_is_named_in_words() -> None:
    assert str(Case("theirs/car.fmu", "tipin15", "mine.fmu")) == "tipin15 on car, mine"


def test_all_kinds_of_a_figure_are_one_line_and_every_other_file_has_its_own(capsys: Capsys) -> None:
    names = ("table.md", "table.csv", "step.png", "step.pdf", "step.svg", "drive.png", "step.json")
    Printing().written(Path("out") / name for name in names)
    assert capsys.readouterr().out.splitlines() == [
        "written: out/table.md",
        "written: out/table.csv",
        "written: out/step.png (and .pdf, .svg)",
        "written: out/drive.png",
        "written: out/step.json",
    ]


@pytest.mark.parametrize("out", [Printing(quiet=True), JsonPrinting(json=True)])
def test_who_wants_no_lines_gets_none(out: Printing, capsys: Capsys) -> None:
    out.written([Path("table.md")])
    out.say("done")
    assert capsys.readouterr().out == ""
