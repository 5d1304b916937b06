"""What the options of a run say."""

from argparse import ArgumentParser

import pytest

from driveline.harness.commands import compare, replay, simulate
from driveline.harness.commands.settings import caption
from driveline.harness.studies.compare.compare import Case

COMMANDS = {simulate: [], compare: [], replay: ["trip.csv"]}


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize(
    ("options", "message"),
    [
        ("", ""),
        ("--fmus /somewhere --build native --quiet", ""),
        ("--seed 3 --set plant.J_1=0.06", "--set plant.J_1=0.06 --seed 3"),
        ("--vehicle van.toml --controller mine.fmu", "--controller mine.fmu --vehicle van.toml"),
    ],
)
def test_a_figure_says_what_was_set(command, options: str, message: str) -> None:
    parser = ArgumentParser()
    command.add_arguments(parser)
    assert caption(parser.parse_args([*COMMANDS[command], *options.split()])) == message


def test_a_figure_says_which_controllers_were_asked_for() -> None:
    parser = ArgumentParser()
    replay.add_arguments(parser)
    both = ["--controller", "DampingController", "--controller", "mine.fmu"]
    assert caption(parser.parse_args(["trip.csv", *both])) == " ".join(both)
    assert caption(parser.parse_args(["trip.csv", *both[:2]])) == ""


def test_a_figure_says_how_a_run_was_made() -> None:
    parser = ArgumentParser()
    simulate.add_arguments(parser)
    assert caption(parser.parse_args(["--step", "0.0005", "--scheme", "jacobi"])) == "--step 0.0005 --scheme jacobi"


def test_a_case_is_named_in_words() -> None:
    assert str(Case("theirs/car.fmu", "tipin15", True)) == "tipin15 on car, damping on"
