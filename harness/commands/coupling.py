"""`driveline coupling`: what co-simulation does to the loop, measured."""

import argparse
from itertools import product
from pathlib import Path

from ..cosimulation.system import BUILD, loop

NAME = "coupling"
HELP = "measure coupling error and dead time of the master"

DESCRIPTION = """\
Runs the loop under both schemes and several communication steps and compares it with its monolithic
solution: the coupling error of each signal, the order with which it falls, and the dead time that a
scheme adds to each connection and around the loop. The result is a page of Markdown.
"""

EXAMPLES = """\
examples:
  driveline coupling                             writes docs/coupling.md
  driveline coupling --output results/coupling.md
"""

STEP = 1e-3
"""Communication step in s of the table of errors, the default of the loop."""

DEAD_TIME_STEPS = (STEP, 0.5 * STEP)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--output",
        type=Path,
        default=Path("docs/coupling.md"),
        metavar="FILE.md",
        help="(default: %(default)s)",
    )
    parser.add_argument(
        "--fmus", type=Path, default=BUILD, metavar="FOLDER", help="of the built FMUs (default: %(default)s)"
    )


def run(args: argparse.Namespace) -> int:
    # here and not above: only this measurement needs the models
    from ..analysis.coupling import MANOEUVRES, PLANTS, Scheme, compare
    from ..analysis.coupling_page import page
    from ..analysis.dead_time import dead_times

    cases = product(PLANTS, MANOEUVRES, Scheme)
    text = page(
        [compare(plant, manoeuvre, scheme, folder=args.fmus) for plant, manoeuvre, scheme in cases],
        {(s, h): dead_times(s, h, args.fmus) for s, h in product(Scheme, DEAD_TIME_STEPS)},
        list(loop().instances),
        STEP,
    )
    args.output.parent.mkdir(parents=True, exist_ok=True)
    args.output.write_text(text, encoding="utf-8")
    print(f"page: {args.output}")
    return 0
