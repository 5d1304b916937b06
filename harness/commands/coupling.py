"""Runs the loop under every scheme and several communication steps and compares it with its monolithic
solution: the coupling error of each signal, the order with which it falls, and the dead time that a
scheme adds to each connection and around the loop; and how far the metrics of every manoeuvre depend on the
communication step. The result is a page of Markdown, coupling.md in the
output folder.

examples:
  driveline study coupling                 writes results/coupling.md
  driveline study coupling --output docs   writes docs/coupling.md
"""

import argparse
from itertools import product

from ..cosimulation.system import Scheme
from ..loop.built_fmus import built
from ..loop.places import PLANTS, STEP_SIZE
from ..loop.settings import loop
from .options import add_fmus, add_output, add_printing
from .printing import Printer

DEAD_TIME_STEPS = (STEP_SIZE, 0.5 * STEP_SIZE)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_fmus(parser)
    add_output(parser, "results", "the page")
    add_printing(parser)


def run(args: argparse.Namespace) -> int:
    for plant in PLANTS:
        built(plant, folder=args.fmus)
    # here and not above: only this measurement needs the models
    from ..base.atomic_files import write_text
    from ..cosimulation.schedule import transfers
    from ..cosimulation.wiring import fit
    from ..studies.coupling.coupling import MANOEUVRES, compare
    from ..studies.coupling.coupling_page import page
    from ..studies.coupling.dead_time import dead_times
    from ..studies.coupling.step_dependence import compare_all

    path = args.output / "coupling.md"
    fitted = fit(loop(folder=args.fmus))
    text = page(
        [
            compare(plant, each, scheme, folder=args.fmus)
            for plant in PLANTS
            for each in MANOEUVRES
            for scheme in Scheme
        ],
        {(s, h): dead_times(s, h, args.fmus) for s, h in product(Scheme, DEAD_TIME_STEPS)},
        transfers(fitted.system, fitted.interfaces),
        list(fitted.interfaces),
        STEP_SIZE,
        compare_all(args.fmus),
    )
    write_text(text, path)
    Printer(args).files([path])
    return 0
