"""Pages are not older than what they are made from, or it is said why."""

import re
from pathlib import Path

import pytest

from docs.studies import digests
from docs.studies.digests import NO_NUMBERS, dependencies, reasons, why_stale
from docs.studies.imports import source
from docs.studies.pages import PAGES, Page
from tests import ROOT

RESULTS = dependencies(PAGES["results"])


@pytest.mark.parametrize("page", PAGES.values(), ids=PAGES)
def test_a_page_is_stale_only_where_stale_toml_says_why(page: Page) -> None:
    files = why_stale(page)
    if page.name in reasons():
        assert files, f"{page.name} is up to date: its line in docs/studies/stale.toml goes"
    else:
        call = page.made_by or f"python -m docs.studies {page.name}"
        assert not files, f"`{call}`, or a line in docs/studies/stale.toml: {page.name} is older than {files}"


def test_only_pages_that_exist_are_excused_with_a_sentence() -> None:
    assert reasons().keys() <= PAGES.keys()
    assert all(reason.endswith(".") and len(reason) > 40 for reason in reasons().values())


@pytest.mark.parametrize(
    "file",
    [
        "models/controller/damping_law.py",
        "models/controller/gains.toml",
        "models/validation_vehicle.py",
        "fmus/native/c/integrator.c",
        "fmus/native/trace.py",
        "harness/cosimulation/master.py",
        "harness/cosimulation/steps.c",
        "harness/manoeuvres/catalogue.py",
        "harness/metrics/step_response.py",
        "harness/studies/compare/compare.py",
    ],
)
def test_the_results_come_from_equations_loop_manoeuvres_and_metrics(file: str) -> None:
    assert file in RESULTS


def test_the_results_do_not_come_from_what_draws_and_prints_or_from_other_studies() -> None:
    others = "harness/(views|commands|design|identification|explorer|exchange|studies/(?!compare/))|fmus/target"
    assert [file for file in RESULTS if re.match(others, file)] == []


def test_cars_that_are_driven_count() -> None:
    assert "examples/cars/van.toml" in dependencies(PAGES["design"])


def test_what_does_not_count_and_what_does_exists() -> None:
    for name in (*NO_NUMBERS, *(module for page in PAGES.values() for module in page.modules)):
        assert source(name).is_file() or source(name).with_suffix("").is_dir(), name


def test_the_files_that_have_changed_come_or_gone_are_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    page = PAGES["recordings"]
    monkeypatch.setattr(digests, "MADE", tmp_path / "made.json")
    monkeypatch.setattr(digests, "STALE", tmp_path / "stale.toml")
    digests.MADE.write_text("{}", encoding="utf-8")
    digests.STALE.write_text('design = "Other."\nrecordings = "This."\n', encoding="utf-8")
    assert why_stale(page) == ["it is not known what it was made from"]
    now = dependencies(page)
    changed, come = list(now)[:2]
    digests.record(page, {file: its for file, its in now.items() if file != come} | {changed: "0", "gone.py": "1"})
    assert why_stale(page) == sorted([changed, come, "gone.py"])
    digests.record(page, now)
    assert why_stale(page) == []
    assert reasons() == {"design": "Other."}


def test_every_page_and_figure_that_is_made_has_its_row() -> None:
    docs = ROOT / "docs"
    made = {path for page in PAGES.values() for pattern in page.writes for path in docs.glob(pattern)}
    assert {path for path in (docs / "figures").iterdir() if path.suffix != ".svg"} == {
        path for path in made if path.parent.name == "figures"
    }
    says_so = {path for path in docs.glob("*.md") if "do not edit" in path.read_text(encoding="utf-8")}
    elsewhere = {docs / f"{page.name.partition('_')[0]}.md" for page in PAGES.values() if page.made_by}
    assert says_so <= made | elsewhere
