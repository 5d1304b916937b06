"""The tutorial gives what it says."""

import re
import shlex
from pathlib import Path

import pytest

from driveline.harness.commands.cli import main
from tests import ROOT
from tests.docs.pages import BLOCK, blocks, commands, text_of

TUTORIAL = ROOT / "docs" / "tutorial.md"


def metrics(folder: str) -> dict[str, list[str]]:
    """The row of each damping in a table of `driveline compare`."""
    rows = Path(folder, "table.md").read_text(encoding="utf-8").splitlines()
    cells = [[cell.strip() for cell in row.split("|")[1:-1]] for row in rows if row.startswith("|")]
    return {damping: row for row in cells for damping in ("off", "on") if damping in row}


@pytest.mark.slow
def test_its_commands_give_its_figures(
    both_built: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    for script in blocks(TUTORIAL, "sh"):
        for arguments in commands(script):
            if arguments[0] in ("simulate", "compare"):
                arguments = [*arguments, "--fmus", str(both_built)]
            if arguments[0] != "build":
                assert main(arguments) == 0, shlex.join(arguments)
    page = text_of(TUTORIAL)
    for damping, row in metrics("results/first").items():
        (shown,) = re.findall(rf"^\| {damping} \|(.*)\|$", page, re.M)
        assert {cell.strip() for cell in shown.split("|")} <= set(row)
    as_it_was, designed = metrics("results/van_as_it_was"), metrics("results/van")
    for value in (*re.findall(r"it overshoots by (\d+) % and settles in (\d+) ms", page)[0],):
        assert value in as_it_was["on"]
    for value in re.findall(r"without damping by (\d+) %, in (\d+) ms", page)[0]:
        assert value in as_it_was["off"]
    overshoot, settling, withheld, before = re.findall(
        r"Now it overshoots by (\d+) % and settles in (\d+) ms, and withholds ([\d.]+) ms in the place of ([\d.]+)\.",
        page,
    )[0]
    assert {overshoot, settling, withheld} <= set(designed["on"])
    assert before in as_it_was["on"]


def test_its_lines_of_python_print_what_it_shows(both_built: Path, capsys: pytest.CaptureFixture[str]) -> None:
    shown = [(language, code) for language, code in BLOCK.findall(text_of(TUTORIAL)) if language in ("python", "text")]
    (_, code), (_, printed) = shown
    exec(code.replace("simulate(tipin, ", f"simulate(tipin, folder=Path({str(both_built)!r}), "), {"Path": Path})
    assert capsys.readouterr().out == printed
