"""Runs on file: with all digits, whole at any time, and refused where they are none."""

from math import isnan, nan

import pytest

from driveline.harness.base.errors import DrivelineError
from driveline.harness.studies.robustness.campaign_archive import COLUMNS, Archive
from tests.harness.studies.robustness.outcomes import outcome


@pytest.fixture
def path(tmp_path):
    return tmp_path / "runs.csv"


def written(path, *outcomes):
    archive = Archive(path)
    archive.begin()
    for each in outcomes:
        archive.add(each)
    return archive


def test_what_was_added_is_read_with_all_digits(path):
    runs = outcome(1, settling_time=0.1 + 0.2), outcome(2, "SpeedWashout", overshoot=nan)
    written(path, *runs)
    found = Archive(path)
    assert list(found) == [each.case for each in runs]
    assert found[runs[0].case] == runs[0]
    assert isnan(found[runs[1].case].measured["overshoot"])


def test_a_run_that_an_fmu_ended_keeps_the_reason(path):
    ended = outcome(1)
    ended = type(ended)(ended.case, ended.measured, 'plant refused a step, "too stiff"')
    written(path, ended)
    assert Archive(path)[ended.case] == ended


def test_a_line_that_was_torn_is_forgotten_and_what_follows_is_whole(path):
    runs = [outcome(number) for number in (1, 2, 3)]
    written(path, *runs[:2])
    path.write_bytes(path.read_bytes()[:-4])
    archive = Archive(path)
    assert list(archive) == [runs[0].case]
    archive.begin()
    archive.add(runs[2])
    assert list(Archive(path)) == [runs[0].case, runs[2].case]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a,b\n1,2\n", "its first line must be plant,controller,number,manoeuvre,settling_time_s,"),
        (",".join(COLUMNS) + "\nTwoMassDriveline,1\n", "line 2: it must have the columns of the first line"),
        (",".join(COLUMNS) + "\n" + ",".join(["x"] * len(COLUMNS)) + "\n", "line 2: it must have the columns"),
    ],
)
def test_a_file_of_something_else_is_refused(path, text, message):
    path.write_text(text)
    with pytest.raises(DrivelineError, match=message):
        Archive(path)
