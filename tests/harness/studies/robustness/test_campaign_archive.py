"""Runs on file: with all digits, with the reason of one that was ended, and refused where they are none."""

from math import isnan, nan
from pathlib import Path

import pytest

from driveline.harness.base.errors import DrivelineError
from driveline.harness.simulation.case_archive import CaseArchive
from driveline.harness.studies.robustness.robustness_campaign import RUNS
from tests.harness.studies.robustness.outcomes import outcome

FIRST = ",".join(RUNS.columns)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "runs.csv"


def written(path, *outcomes):
    archive = CaseArchive(path, RUNS)
    for each in outcomes:
        archive[each.case] = each


def test_what_was_added_is_read_with_all_digits(path):
    runs = outcome(1, settling_time=0.1 + 0.2), outcome(2, "SpeedWashout", overshoot=nan)
    written(path, *runs)
    found = CaseArchive(path, RUNS)
    assert list(found) == [each.case for each in runs]
    assert found[runs[0].case] == runs[0]
    assert isnan(found[runs[1].case].measured["overshoot"])


def test_a_run_that_an_fmu_ended_keeps_the_reason(path):
    ended = outcome(1)
    ended = type(ended)(ended.case, ended.measured, 'plant refused a step, "too stiff"')
    written(path, ended)
    assert CaseArchive(path, RUNS)[ended.case] == ended


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a,b\n1,2\n", "its first line must be plant,controller,number,manoeuvre,settling_time_s,"),
        (f"{FIRST}\nTwoMassDriveline,1\n", "line 2: it must have the columns of the first line"),
        (
            ",".join(RUNS.columns) + "\n" + ",".join(["x"] * len(RUNS.columns)) + "\n",
            "line 2: it must have the columns",
        ),
    ],
)
def test_a_file_of_something_else_is_refused(path, text, message):
    path.write_text(text)
    with pytest.raises(DrivelineError, match=message):
        CaseArchive(path, RUNS)
