"""What commands print."""

from pathlib import Path

import pytest

from driveline.harness.commands.printing import JsonPrinting, Printing


def test_all_kinds_of_a_figure_are_one_line_and_every_other_file_has_its_own(
    capsys: pytest.CaptureFixture[str],
) -> None:
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
def test_who_wants_no_lines_gets_none(out: Printing, capsys: pytest.CaptureFixture[str]) -> None:
    out.written([Path("table.md")])
    out.say("done")
    assert capsys.readouterr().out == ""
