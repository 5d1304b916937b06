"""What commands print."""

from argparse import Namespace
from pathlib import Path

import pytest

from driveline.harness.commands.printing import Printer


def test_all_kinds_of_a_figure_are_one_line_and_every_other_file_has_its_own(
    capsys: pytest.CaptureFixture[str],
) -> None:
    names = ("table.md", "table.csv", "step.png", "step.pdf", "step.svg", "drive.png", "step.json")
    Printer(Namespace(quiet=False)).files(Path("out") / name for name in names)
    assert capsys.readouterr().out.splitlines() == [
        "written: out/table.md",
        "written: out/table.csv",
        "written: out/step.png (and .pdf, .svg)",
        "written: out/drive.png",
        "written: out/step.json",
    ]


@pytest.mark.parametrize("silent", [{"quiet": True}, {"quiet": False, "json": True}])
def test_who_wants_no_lines_gets_none(silent: dict[str, bool], capsys: pytest.CaptureFixture[str]) -> None:
    out = Printer(Namespace(**silent))
    out.files([Path("table.md")])
    out.say("done")
    assert capsys.readouterr().out == ""
