"""`driveline back-to-back`: the builds of each block against each other and against its functions."""

import argparse
import sys
from itertools import product

from ..loop.built_fmus import built
from ..loop.places import BUILDS, PLANTS
from ..manoeuvres.catalogue import MANOEUVRES
from .options import add_fmus, add_output, add_printing
from .printing import Printer

DESCRIPTION = """\
Feeds random inputs and those of all manoeuvres to the Python functions of each block and to both builds of
its FMU, and exchanges the builds in the loop one by one. The result is a page of Markdown with the
differences, back_to_back.md in the output folder; the exit code is 1 if one is larger than allowed.
"""

EXAMPLES = """\
examples:
  driveline back-to-back                             writes results/back_to_back.md
  driveline back-to-back --output docs               writes docs/back_to_back.md
"""

RANDOM_STEPS = 20_000

ALLOWED = 1e-9
"""Of any difference; after some crossings of the flanks rounding has grown to this."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_fmus(parser)
    add_output(parser, "results", "the page")
    add_printing(parser)


def run(args: argparse.Namespace) -> int:
    for plant, build in product(PLANTS, BUILDS):
        built(plant, args.fmus, build)
    # here and not above: only this measurement needs the models
    from ...fmus.catalogue import FMUS
    from ..base.atomic_files import write_text
    from ..simulation.many_runs import run_many
    from ..studies.back_to_back.back_to_back import Differences, compare_block, compare_loop, random_inputs
    from ..studies.back_to_back.back_to_back_page import LoopRow, page

    def compare_alone(name: str) -> Differences:
        return compare_block(name, random_inputs(FMUS[name].block, RANDOM_STEPS), args.fmus)

    random = dict(zip(FMUS, run_many(compare_alone, FMUS, label="blocks alone"), strict=True))
    cases = list(product(PLANTS, MANOEUVRES))
    found = run_many(
        lambda case: compare_loop(case[0], MANOEUVRES[case[1]], args.fmus), cases, label="blocks in the loop"
    )
    loops = [LoopRow(plant, name, blocks) for (plant, name), blocks in zip(cases, found, strict=True)]
    path = args.output / "back_to_back.md"
    write_text(page(random, RANDOM_STEPS, loops), path)
    largest = max(max(d) for row in (random, *(row.blocks for row in loops)) for d in row.values())
    out = Printer(args)
    out.say(f"largest difference: {largest:.0e}")
    out.say(f"page: {path}")
    if largest > ALLOWED:
        print(f"driveline back-to-back: a difference of {largest:.0e}; allowed is {ALLOWED:.0e}", file=sys.stderr)
    return 0 if largest <= ALLOWED else 1
