"""Numbers that are kept: what counts as the same, what a file gives back, and what pages say of them."""

import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from fmutesting.skipping import skipped_if_impossible
from fmutesting.together import together

from docs.site import numbers
from docs.site.numbers import as_markdown, disagreements, shown
from docs.studies import data_file, results
from docs.studies.__main__ import build_all, check, make, sentinel_differences
from docs.studies.pictures import FIGURES, SHOWN
from docs.studies.study import STUDIES, Column, Measured, Table, differences, study
from driveline.harness.views.panels import DASHED, Axis, Band, Curve, Drawing, Level, Panel
from fmublocks.errors import BuildError
from tests import ROOT
from tests.docs.pages import PAGES, text_of

MS = Column("settling", "ms", 0, 0.02)


@pytest.mark.parametrize(
    ("was", "now", "same"),
    [
        (200.0, 203.9, True),  # 2 %
        (200.0, 204.5, False),
        (10.0, 10.5, True),  # half of the last decimal that is shown
        (10.0, 10.6, False),
        (None, None, True),
        (None, 1.0, False),
        ("demand_lead", "demand_lead", True),
        ("demand_lead", 1.0, False),
    ],
)
def test_a_number_is_the_same_within_its_tolerance_or_half_a_digit(was, now, same) -> None:
    assert MS.within(was, now) is same


def table(**rows: float) -> Table:
    return Table("run", (MS,), {name: (value,) for name, value in rows.items()})


def test_what_has_moved_is_named_with_row_was_is_and_tolerance_also_what_is_new() -> None:
    (moved,) = differences({"runs": table(tipin=70.0, launch=120.0)}, {"runs": table(tipin=80.0)})
    assert str(moved) == "runs, tipin, settling: was 70, is 80, tolerance 2 %, at least 0.5 ms"
    (row,) = differences({"runs": table(tipin=70.0)}, {"runs": table(creep=70.0)})
    assert (row.row, row.was) == ("creep", "no such row")
    other = table(tipin=70.0)._replace(columns=(MS._replace(name="delay"),))
    (column,) = differences({"runs": other}, {"runs": table(tipin=70.0)})
    assert (column.was, column.now) == ("delay", "settling")


def drawing(y: np.ndarray) -> Drawing:
    x = np.linspace(0.0, 10.0, len(y))
    parts = [Curve(x, y, "T", dashes=DASHED), Band(x, y - 1.0, y), Level(0.5)]
    return Drawing([[Panel("torque in N·m", parts, note="rms 3")]], Axis("time in s", (2.0, 4.0)), "a step")


def test_a_file_gives_back_what_was_measured(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(data_file, "DATA", tmp_path)
    y = np.sin(np.arange(50.0))
    y[20] = np.nan
    data_file.write("one", Measured({"runs": table(tipin=1 / 3)}, {"step": drawing(y)}), (1, 2), 1.5)
    found = data_file.read("one")
    assert found.measured.tables == {"runs": table(tipin=0.333333)}
    assert found.origin.startswith("measured at ")
    panel = found.measured.figures["step"].rows[0][0]
    curve = panel.parts[0]
    assert isinstance(curve, Curve)
    seen = (np.linspace(0.0, 10.0, 50) >= 2.0) & (np.linspace(0.0, 10.0, 50) <= 4.0)
    np.testing.assert_allclose(curve.y, y[seen], rtol=1e-4)
    assert panel.note == "rms 3"


def test_a_thinned_curve_keeps_its_extremes() -> None:
    y = np.zeros(100_000)
    y[12_345], y[54_321] = 7.0, -3.0
    curve = data_file.thinned(Curve(np.arange(100_000.0), y))
    assert len(curve.x) <= 2 * data_file.POINTS
    assert (curve.y.max(), curve.y.min()) == (7.0, -3.0)
    assert curve.x[curve.y.argmax()] == 12_345


def test_a_page_gets_its_tables_and_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    kept = data_file.Kept("abc", "2026-11-26", {}, 1.0, Measured({"runs": table(tipin=70.4)}))
    monkeypatch.setattr(numbers, "kept", lambda _: kept)
    page = "[table: one/runs](studies/data/one.json)\n\nIt takes [70 ms](studies/data/one.json#runs/tipin/settling).\n"
    text = shown(page)
    assert as_markdown(table(tipin=70.4)) in text
    assert text.count("measured at abc on 2026-11-26") == 2
    assert "studies/data" not in text
    assert not [*disagreements(page)]
    assert len([*disagreements(page.replace("[70 ms", "[71 ms"))]) == 1
    assert len([*disagreements(page.replace("[70 ms", "[70.5 ms"))]) == 1
    with pytest.raises(LookupError, match="no such cell"):
        list(disagreements(page.replace("tipin", "creep")))


@together("page", PAGES)
def test_the_numbers_of_a_page_are_those_of_the_studies(page: Path) -> None:
    assert not [*disagreements(text_of(page))]
    for kind, name, part in numbers.SHOWN.findall(text_of(page)):
        if kind == "figure":
            assert part in data_file.read(name).measured.figures
        elif part:
            assert part in data_file.read(name).measured.tables
        else:
            assert name in numbers.TABLES


@together("page", PAGES)
def test_no_table_of_a_page_has_a_measured_number_typed_by_hand(page: Path) -> None:
    ours = results.readme_table(data_file.read("results").measured.tables)
    assert not numbers.TYPED.findall(re.sub(r"^```.*?^```", "", text_of(page).replace(ours, ""), flags=re.M | re.S))


@pytest.mark.parametrize(
    ("row", "typed"),
    [
        ("| tip-in | 70 ms | 9 % |", ["70 ms", "9 %"]),
        ("| rms | 1.9 | 10.1 instead of 12 N·m |", ["1.9", "10.1 instead of 12 N·m"]),
        ("| exit code | 2 | `0.5` | 1.9 of those | [70 ms](studies/data/one.json#a/b/c) |", []),
    ],
)
def test_what_is_typed_is_told_from_what_is_linked(row: str, typed: list[str]) -> None:
    assert numbers.TYPED.findall(row) == typed


def test_the_table_of_the_readme_is_that_of_the_results() -> None:
    made = results.readme_table(data_file.read("results").measured.tables)
    assert made in text_of(ROOT / "README.md"), f"the README is to have\n{made}"


@pytest.mark.parametrize("name", [name for name in STUDIES if study(name).again])
def test_the_sentinels_of_a_study_are_as_they_were(name: str, study_folder: Path) -> None:
    assert any(study(name).sentinels.values())
    build_all()
    with skipped_if_impossible():  # the target needs a compiler of its own and its emulator
        moved = sentinel_differences(name)
    assert not moved, "\n".join([*map(str, moved), f"`python -m docs.studies {name}` measures it anew"])


@pytest.mark.parametrize("measured", [make, check])
def test_where_a_study_cannot_be_measured_the_others_are(measured, monkeypatch, capsys) -> None:
    def impossible() -> None:
        raise BuildError("there is no compiler for the target")

    one = SimpleNamespace(purpose="costs", seconds=1.0, measure=impossible, again=impossible)
    monkeypatch.setattr("docs.studies.__main__.study", lambda _: one)
    assert measured(["target", "goals"]) == 1
    said = [line for line in capsys.readouterr().out.splitlines() if "not measured: there is no compiler" in line]
    assert ["target" in said[0], "goals" in said[1]] == [True, True]


def test_the_pictures_in_git_are_those_of_readme_and_tutorial_and_small() -> None:
    pictures = {path.stem: path.stat().st_size for path in FIGURES.glob("*.png")}
    assert pictures.keys() == {*SHOWN, "explore"}
    assert max(pictures.values()) <= 150_000
