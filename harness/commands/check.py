"""`driveline check`: compliance of FMUs, for people and for CI."""

import argparse
from pathlib import Path

from .options import add_printing
from .printing import Printer

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
  driveline check --json build/*.fmu > findings.json
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    files = parser.add_argument("fmus", nargs="+", type=Path, metavar="FILE.fmu", help="the FMUs to check")
    files.complete = "file"  # type: ignore[attr-defined]
    add_printing(parser, table=True)


def run(args: argparse.Namespace) -> int:
    from ..compliance.check import check
    from ..reports.terminal import print_verdict

    out = Printer(args)
    found = []
    for path in args.fmus:
        out.say(str(path))
        verdicts = []
        for verdict in check(path):
            verdicts.append(verdict)
            if not out.silent:
                print_verdict(verdict.title, verdict.problems)
            elif not out.json:
                print("".join(f"{path}: {problem}\n" for problem in verdict.problems), end="")
        found.append({"fmu": path, "verdicts": [verdict._asdict() for verdict in verdicts]})
    findings = sum(len(verdict["problems"]) for fmu in found for verdict in fmu["verdicts"])
    out.say(f"{findings or 'no'} finding{'s' * (findings != 1)} in {len(args.fmus)} FMU(s)")
    out.document({"findings": findings, "fmus": found})
    return 1 if findings else 0
