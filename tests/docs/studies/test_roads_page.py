"""The page of roads without grip and of wrong frames: what it counts, and where it puts it."""

import pytest

from docs.studies.grip_and_frames import OURS, STUDIES, Ratios, Run, show
from docs.studies.roads_page import CONTROLLERS, Key, page
from driveline.harness.manoeuvres.catalogue import MANOEUVRES

GOOD, BAD, AT_MOST = Ratios(0.5, 0.25, 0.0), Ratios(1.3, 1.75, 0.5), Ratios(1.1, 1.2, 0.0)


def rows(found: dict[Key, list[Ratios]]) -> list[list[str]]:
    """Cells of all tables of the page, of two groups of two runs in each study."""
    runs = {study: [Run(f"{study} {k // 2}", MANOEUVRES["launch"]) for k in range(4)] for study in STUDIES}
    lines = page(runs, found).splitlines()
    return [[cell.strip(" `") for cell in line.split("|")[1:-1]] for line in lines if line.startswith("| ")]


def test_each_controller_has_its_worst_run_its_mean_and_the_runs_beyond_what_is_asked() -> None:
    found = {Key(study, name): [GOOD] * 4 for study in STUDIES for name in CONTROLLERS}
    found[Key("grip", "LinearObserver")] = [GOOD, GOOD, AT_MOST._replace(rms=1.1), BAD]
    table = rows(found)
    assert ["grip", "LinearObserver", "1.30", "0.85", "1.75", "0.84", "1", "0.50"] in table
    assert ["abs", "LinearObserver", "0.50", "0.50", "0.25", "0.25", "0", "0.00"] in table


def test_ours_is_shown_by_groups() -> None:
    found = {Key(study, name): [GOOD] * 4 for study in STUDIES for name in CONTROLLERS}
    found[Key("abs", OURS)] = [GOOD, GOOD, GOOD, BAD]
    table = rows(found)
    assert ["abs 0", "2", "0.50", "0.50", "0.25", "0.25", "0", "0.00"] in table
    assert ["abs 1", "2", "1.30", "0.90", "1.75", "1.00", "1", "0.50"] in table


def test_a_frame_has_a_cell_for_each_controller() -> None:
    found = {Key(study, name): [GOOD] * 4 for study in STUDIES for name in CONTROLLERS}
    found[Key("frames", CONTROLLERS[1])] = [AT_MOST, BAD, GOOD, GOOD]
    others = ["0.25 / 0.25 / 0"] * (len(CONTROLLERS) - 2)
    table = rows(found)
    assert ["frames 0", "0.25 / 0.25 / 0", "1.75 / 1.48 / 1", *others] in table
    assert ["frames 1", *["0.25 / 0.25 / 0"] * len(CONTROLLERS)] in table


@pytest.mark.parametrize(("begin", "heading", "beyond"), [(None, "over 1.1", "2"), (1.1, "rms over 1.2", "1")])
def test_the_command_counts_what_the_page_counts(
    begin: float | None, heading: str, beyond: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    show([Run("all of them", MANOEUVRES["launch"], begin=begin)] * 3, [GOOD, AT_MOST, BAD], "a study")
    printed = capsys.readouterr().out
    assert heading in printed
    (line,) = [line for line in printed.splitlines() if "all of them" in line]
    assert [cell.strip() for cell in line.split("│")[1:-1]][6] == beyond
