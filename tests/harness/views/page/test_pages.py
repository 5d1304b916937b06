"""The reports of the commands, opened in a browser."""

from pathlib import Path

import pytest

from driveline.harness.commands.cli import main
from driveline.harness.views.colours import BLUE, GREY, VERMILION
from tests import ROOT
from tests.browser import Browser

LARGEST = 2_000_000
"""Bytes of a report."""


@pytest.fixture(scope="module")
def comparison(both_built: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two manoeuvres on the design model."""
    folder = tmp_path_factory.mktemp("compared")
    page = folder / "comparison.html"
    runs = ["--manoeuvre", "tipin15", "--manoeuvre", "creep", "--plant", "TwoMassDriveline"]
    written = ["--output", str(folder), "--report", str(page), "--quiet"]
    assert main(["compare", *runs, "--fmus", str(both_built), *written]) == 0
    return page


@pytest.fixture
def opened(chromium: Browser, comparison: Path) -> Browser:
    chromium.open(comparison.as_uri())
    return chromium


def require_clean(page: Path, browser: Browser) -> None:
    """It is small, nothing but the page itself was asked for, and nothing was written to the console."""
    assert page.stat().st_size < LARGEST
    assert browser.fetched() == [page.as_uri()]
    assert browser.console() == []


def test_the_curves_are_there_and_nothing_is_fetched_and_the_console_is_silent(
    opened: Browser, comparison: Path
) -> None:
    torque = opened.figure("gear torque in N·m")
    assert torque.pixels(BLUE) > 300
    assert torque.pixels(GREY) > 300
    assert opened.figure("gear torque over demand").pixels(BLUE) > 300
    require_clean(comparison, opened)


def test_a_box_zooms_all_panels_in_time_and_none_in_frequency(opened: Browser) -> None:
    torque, speed = opened.figure("gear torque in N·m"), opened.figure("motor speed in rad/s")
    frequency = opened.figure("gear torque over demand")
    (start, end), before = speed.x(), frequency.x()
    torque.zoom()
    zoomed = speed.x()
    assert zoomed == torque.x()
    assert zoomed[0] == pytest.approx(start + 0.3 * (end - start), abs=0.03 * (end - start))
    assert zoomed[1] == pytest.approx(start + 0.6 * (end - start), abs=0.03 * (end - start))
    assert frequency.x() == before
    assert torque.pixels(BLUE) > 300


def test_a_click_in_the_legend_hides_the_curve_and_another_shows_it(opened: Browser) -> None:
    torque = opened.figure("gear torque in N·m")
    shown = torque.pixels(BLUE)
    torque.click_on_legend(1)
    assert torque.pixels(BLUE) == 0
    assert torque.pixels(GREY) > 300
    torque.click_on_legend(1)
    assert torque.pixels(BLUE) == shown


def test_a_click_on_a_row_shows_that_run(opened: Browser) -> None:
    torque = opened.figure("gear torque in N·m")
    assert torque.x() == (0.9, 2.4)
    opened.js("document.querySelector('tr[data-choice^=creep]').click()")
    opened.painted()
    assert torque.x() == (0.0, 12.0)
    assert opened.js("controls.get('Run').select.value") == "creep on TwoMassDriveline"
    assert opened.js("document.querySelectorAll('tr.chosen').length") >= 2


def test_headings_say_what_their_columns_mean_and_the_page_what_made_it(opened: Browser) -> None:
    titles = opened.js("[...document.querySelectorAll('th[title]')].map((each) => each.title)")
    assert any(title.startswith("time until the gear torque swings by less than 5 %") for title in titles)
    text = opened.js("document.body.textContent")
    assert "compare --manoeuvre tipin15" in text
    assert "sha256:" in text
    assert "in 2 of 2 runs" in text


@pytest.mark.slow
def test_the_report_of_a_replay_shows_pieces_of_the_drive(chromium: Browser, both_built: Path, tmp_path: Path) -> None:
    page = tmp_path / "replay.html"
    drive = ROOT / "harness/manoeuvres/data/town_drive.csv"
    written = ["--output", str(tmp_path), "--report", str(page), "--quiet"]
    assert main(["replay", str(drive), "--plant", "TwoMassDriveline", "--fmus", str(both_built), *written]) == 0
    chromium.open(page.as_uri())
    torque = chromium.figure("gear torque in N·m")
    assert torque.pixels(BLUE) > 300
    chromium.js("document.querySelector('tr[data-choice]').click()")
    chromium.painted()
    start, end = torque.x()
    assert end - start == 6.0
    assert torque.pixels(BLUE) > 100
    assert chromium.figure("share of the time in %").pixels(BLUE) > 100
    require_clean(page, chromium)


def test_the_report_of_an_identification_shows_prediction_and_response(
    chromium: Browser, both_built: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("driveline.harness.commands.identify.draw", lambda *_: [])
    recorded = ["--duration", "4", "--fmus", str(both_built), "--output", str(tmp_path), "--quiet"]
    assert main(["record", *recorded]) == 0
    recording, page = tmp_path / "TwoMassDriveline_prbs_off.csv", tmp_path / "identified.html"
    written = ["--output", str(tmp_path / "car.toml"), "--report", str(page), "--quiet"]
    assert main(["identify", str(recording), *written]) == 0
    chromium.open(page.as_uri())
    for label, colour in (
        ("motor speed in rad/s", BLUE),
        ("motor speed over torque in dB", VERMILION),
        ("load torque in N·m, wheel side", BLUE),
    ):
        assert chromium.figure(label).pixels(colour) > 100, label
    require_clean(page, chromium)


@pytest.mark.slow
def test_the_report_of_a_campaign_of_cars_shows_distributions_and_the_worst(
    chromium: Browser, both_built: Path, tmp_path: Path
) -> None:
    page = tmp_path / "robustness.html"
    what = ["--cases", "2", "--plant", "TwoMassDriveline", "--controller", "DampingController"]
    written = ["--output", str(tmp_path), "--report", str(page), "--quiet"]
    assert main(["robustness", *what, "--fmus", str(both_built), *written]) == 0
    chromium.open(page.as_uri())
    assert chromium.figure("share of the draws in %").pixels(BLUE) > 300
    assert chromium.figure("gear torque in N·m").pixels(BLUE) > 300
    require_clean(page, chromium)


@pytest.mark.slow
def test_the_report_of_faults_shows_the_worst_cases(chromium: Browser, both_built: Path, tmp_path: Path) -> None:
    page = tmp_path / "faults.html"
    what = ["--cases", "4", "--seed", "2", "--plant", "TwoMassDriveline", "--fmus", str(both_built)]
    assert main(["faults", *what, "--output", str(tmp_path), "--report", str(page), "--quiet"]) in (0, 1)
    chromium.open(page.as_uri())
    judged = chromium.figure("measured over limit")
    assert judged.pixels(BLUE) > 0
    assert judged.js("figure.panel.parts.every(({y}) => y.length > 100 && y.every(Number.isFinite))")
    assert chromium.figure("gear torque in N·m").pixels(BLUE) > 300
    require_clean(page, chromium)
