"""`driveline back-to-back`: the builds of each block against each other and against its functions."""

import argparse
from itertools import product, repeat
from pathlib import Path

from ..cosimulation.system import BUILD, PLANTS
from ..manoeuvres.catalogue import MANOEUVRES
from ..workers import workers

NAME = "back-to-back"
HELP = "compare both builds of each block with its functions"

DESCRIPTION = """\
Feeds random inputs and those of all manoeuvres to the Python functions of each block and to both builds of
its FMU, and exchanges the builds in the loop one by one. The result is a page of Markdown with the
differences; the exit code is 1 if one is larger than allowed.
"""

EXAMPLES = """\
examples:
  driveline back-to-back                             writes docs/back_to_back.md
  driveline back-to-back --output results/b2b.md
"""

RANDOM_STEPS = 20_000

ALLOWED = 1e-9
"""Of any difference; after some crossings of the flanks rounding has grown to this."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--output",
        type=Path,
        default=Path("docs/back_to_back.md"),
        metavar="FILE.md",
        help="(default: %(default)s)",
    )
    parser.add_argument(
        "--fmus",
        type=Path,
        default=BUILD,
        metavar="FOLDER",
        help="of the built FMUs, with the native ones in its folder native (default: %(default)s)",
    )


def run(args: argparse.Namespace) -> int:
    # here and not above: only this measurement needs the models
    from fmus.catalogue import FMUS

    from ..analysis.back_to_back import compare_block, compare_loop, random_inputs
    from ..analysis.back_to_back_page import LoopRow, page

    random = {
        name: compare_block(name, random_inputs(fmu.block, RANDOM_STEPS), args.fmus) for name, fmu in FMUS.items()
    }
    plants, names = zip(*product(PLANTS, MANOEUVRES), strict=True)
    with workers() as pool:
        found = pool.map(compare_loop, plants, [MANOEUVRES[name] for name in names], repeat(args.fmus))
        loops = [LoopRow(*row) for row in zip(plants, names, found, strict=True)]
    args.output.parent.mkdir(parents=True, exist_ok=True)
    args.output.write_text(page(random, RANDOM_STEPS, loops), encoding="utf-8")
    largest = max(max(d) for row in (random, *(row.blocks for row in loops)) for d in row.values())
    print(f"largest difference: {largest:.0e}")
    print(f"page: {args.output}")
    return 0 if largest <= ALLOWED else 1
