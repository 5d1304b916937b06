"""`driveline check`: compliance of FMUs, for people and for CI."""

import argparse
from pathlib import Path

from rich.console import Console
from rich.text import Text

from ..compliance.check import check

NAME = "check"
HELP = "check FMUs for compliance"

DESCRIPTION = """\
Checks any FMI 2.0 Co-Simulation FMU: its archive, its model description (with fmpy, and what fmpy does
not look at: units, dependencies, documentation) and its behaviour (default experiment, odd step sizes,
reset, several instances, saved states), the latter in processes of their own.

Exit code 0: nothing found; 1: findings, each on a line of its own; 2: no such file.
"""

EXAMPLES = """\
examples:
  driveline check build/TwoMassDriveline.fmu
  driveline check build/*.fmu
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("fmus", nargs="+", type=Path, metavar="FILE.fmu", help="the FMUs to check")


def run(args: argparse.Namespace) -> int:
    console = Console(highlight=False, soft_wrap=True)
    findings = 0
    for path in args.fmus:
        console.print(Text(str(path), style="bold"))
        for verdict in check(path):
            mark = Text("  FOUND ", style="red") if verdict.problems else Text("  ok    ", style="green")
            console.print(mark + verdict.title)
            for problem in verdict.problems:
                console.print(Text(f"        - {problem}"))
            findings += len(verdict.problems)
    console.print(f"{findings or 'no'} finding{'s' * (findings != 1)} in {len(args.fmus)} FMU(s)")
    return 1 if findings else 0
