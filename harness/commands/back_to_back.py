"""Feeds random inputs and those of the thirteen manoeuvres of the studies to the Python functions of each block
and to both builds of its FMU, and exchanges the builds in the loop one by one. The result is a page of Markdown with
the differences, back_to_back.md in the output folder; the exit code is 1 if one is larger than allowed.

examples:
  driveline study back-to-back                 writes results/back_to_back.md
  driveline study back-to-back --output docs   writes docs/back_to_back.md
"""

import argparse
import sys
from itertools import product

from ..loop.built_fmus import built_together
from ..loop.places import BUILDS, PLANTS
from ..loop.settings import Settings
from .options import add_fmus, add_output, add_printing
from .printing import Printer

RANDOM_STEPS = 20_000

ALLOWED = 1e-9
"""Of any difference; after some crossings of the flanks rounding has grown to this."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_fmus(parser)
    add_output(parser, "results", "the page")
    add_printing(parser)


def run(args: argparse.Namespace) -> int:
    made, *_ = built_together(Settings(p, folder=args.fmus, build=b) for p, b in product(PLANTS, BUILDS))
    # here and not above: only this measurement needs the models
    from ..base.atomic_files import write_text
    from ..studies.back_to_back.back_to_back import compare_all
    from ..studies.back_to_back.back_to_back_page import page

    random, loops = compare_all(RANDOM_STEPS, made.folder)
    path, out = args.output / "back_to_back.md", Printer(args)
    write_text(page(random, RANDOM_STEPS, loops), path)
    largest = max(max(d) for row in (random, *(row.blocks for row in loops)) for d in row.values())
    out.say(f"largest difference: {largest:.0e}")
    out.files([path])
    if largest > ALLOWED:
        print(f"driveline study back-to-back: a difference of {largest:.0e}; allowed is {ALLOWED:.0e}", file=sys.stderr)
    return 0 if largest <= ALLOWED else 1
