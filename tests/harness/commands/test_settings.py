"""What the options of a run say."""

import pytest

from driveline.harness.commands.settings import caption
from driveline.harness.studies.compare.compare import Case
from tests.harness.commands import given

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
    assert str(Case("theirs/car.fmu", "tipin15", True)) == "tipin15 on car, damping on"
