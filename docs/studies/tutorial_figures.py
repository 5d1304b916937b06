"""The figures of docs/tutorial.md, made by its own commands."""

import re
import shlex
import shutil
from collections.abc import Iterator
from contextlib import chdir
from pathlib import Path
from tempfile import TemporaryDirectory

from docs.studies.imports import ROOT
from driveline.harness.commands.cli import main as driveline

PAGE = ROOT / "docs" / "tutorial.md"

FIGURES = {
    "tutorial_oscillation.png": "results/simulate/TwoMassDriveline_tipin15_off.png",
    "tutorial_damped.png": "results/first/TwoMassDriveline_tipin15.png",
    "tutorial_van.png": "results/van/TwoMassDriveline_tipin15.png",
}
"""The files in docs/figures, with where the commands of the page write them."""


def commands() -> Iterator[list[str]]:
    """The arguments of each `driveline` on the page, in their order, but for those that build the FMUs."""
    for block in re.findall(r"^```sh\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.M | re.S):
        for line in block.splitlines():
            program, *arguments = shlex.split(line, comments=True)
            if program == "driveline" and arguments != ["build"]:
                yield arguments


def make(folder: Path) -> None:
    (folder / "figures").mkdir(exist_ok=True)
    with TemporaryDirectory(dir=folder) as own, chdir(own):
        Path("examples").symlink_to(ROOT / "examples")
        for arguments in commands():
            if driveline(arguments) != 0:
                raise SystemExit(f"docs/tutorial.md: driveline {shlex.join(arguments)}")
        for figure, written in FIGURES.items():
            shutil.copyfile(written, folder / "figures" / figure)
