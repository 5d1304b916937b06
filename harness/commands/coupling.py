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

from ..loop.built_fmus import built_together
from ..loop.places import PLANTS, STEP_SIZE
from ..loop.settings import Settings, loop
from .options import add_fmus, add_output, add_printing
from .printing import Printer


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_fmus(parser)
    add_output(parser, "results", "the page")
    add_printing(parser)


def run(args: argparse.Namespace) -> int:
    folder = built_together(Settings(plant, folder=args.fmus) for plant in PLANTS)[0].folder
    # here and not above: only this measurement needs the models
    from ..base.atomic_files import write_text
    from ..cosimulation.schedule import transfers
    from ..cosimulation.wiring import fit
    from ..studies.coupling.coupling import compare_all
    from ..studies.coupling.coupling_page import page
    from ..studies.coupling.dead_time import all_dead_times
    from ..studies.coupling.step_dependence import compare_all as compare_steps

    path, fitted = args.output / "coupling.md", fit(loop(folder=folder))
    moving, order = transfers(fitted.system, fitted.interfaces), list(fitted.interfaces)
    comparisons, late, metrics = compare_all(folder), all_dead_times(folder), compare_steps(folder)
    write_text(page(comparisons, late, moving, order, STEP_SIZE, metrics), path)
    Printer(args).files([path])
    return 0
