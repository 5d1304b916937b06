"""Reports as files: refused in time, complete or absent, safe whatever names they show."""

from pathlib import Path

import numpy as np
import pytest

from driveline.harness.commands.cli import main
from driveline.harness.views.page.figures import figure
from driveline.harness.views.page.report import Heading, Row, Section, Table, write_report
from driveline.harness.views.panels import Axis, Curve, Panel

PROVENANCE = {"program": "p", "commit": None, "command_line": "c", "fmus": {}, "inputs": {}, "run": {"seed": 1}}

ONE = np.ones(1)


@pytest.mark.parametrize("command", ["compare", "replay drive.csv", "identify drive.csv", "robustness", "faults"])
def test_a_report_that_is_no_page_is_refused_before_anything_is_run(
    command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main([*command.split(), "--report", "report.pdf"]) == 2
    assert capsys.readouterr().err.endswith("--report report.pdf: a report is a .html file\n")
    assert not list(tmp_path.iterdir())


def test_the_report_of_another_run_is_not_replaced(
    both_built: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page = tmp_path / "report.html"
    page.write_text("mine", encoding="utf-8")
    run = ["compare", "--manoeuvre", "tipin15", "--fmus", str(both_built), "--output", str(tmp_path / "out")]
    assert main([*run, "--report", str(page), "--quiet"]) == 2
    assert f"{page} is there" in capsys.readouterr().err
    assert page.read_text(encoding="utf-8") == "mine"


def test_names_of_files_are_text_and_nothing_else(tmp_path: Path) -> None:
    evil = "<script>alert(1)</script>"
    table = Table([Heading(evil, evil, True)], [Row([evil], evil)], [evil])
    figures = [figure([Panel(evil, [Curve(ONE, ONE, evil)], evil)], Axis(evil, (0.0, 1.0)))]
    provenance = {**PROVENANCE, "inputs": {evil: evil}}
    write_report(evil, evil, [Section(evil, evil, table, figures)], provenance, tmp_path / "page.html")
    text = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert evil not in text
    assert text.count("&lt;script&gt;alert(1)") >= 9
    assert [path.name for path in tmp_path.iterdir()] == ["page.html"]
