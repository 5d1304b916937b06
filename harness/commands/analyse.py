"""Analyses the loop with a controller of the catalogue: gain, phase and delay margins and M_s with the true delays,
Bode and Nyquist figures, the poles over speed, stiffness, inertia and dead time, the describing function of the
backlash and the limit cycles that it excludes, the error of the estimate and its time in the wrong contact mode, and
the sensitivity of the metrics to each parameter of car and controller.

The linear model comes from the functions of the blocks themselves, differentiated with the teeth in contact. The table
of margins is printed; the output folder gets the page analysis.md, sensitivity.csv, analysis.json (what made them) and,
in its folder figures, the figures.

examples:
  driveline analyse
  driveline analyse --controller SpeedWashout --output results/washout
  driveline analyse --vehicle examples/cars/van.toml --parameters van_gains.toml --output results/van
  driveline analyse --plant TwoMassDriveline --json > analysis.json
"""

import argparse
from math import isfinite
from typing import Any

from ..loop.places import PLANTS
from .course import job
from .options import add_controller, add_fmus, add_output, add_printing
from .settings import as_given, distinguishing, settings_of_ours


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--plant",
        action="append",
        choices=PLANTS,
        metavar="NAME",
        help=f"the car: {' or '.join(PLANTS)} (repeatable; default: both)",
    )
    add_controller(parser)
    add_fmus(parser)
    add_output(parser, "results/analyse", "the page, the table of sensitivities and the figures", of_a_run=True)
    add_printing(parser, table=True)


def run(args: argparse.Namespace) -> int:
    given = settings_of_ours(args, dict.fromkeys(args.plant or PLANTS))
    # here and not above: mistakes and help are answered without them
    from ..studies.margins.analysis_report import announce, write
    from ..studies.margins.loop_analysis import analyse

    same = {plant: distinguishing(each) for plant, each in given.items()}
    with job(args, args.output / "analysis.json", same, given, [args.output / "analysis.md"]) as made:
        found = analyse(given)
        made.begin()
        made.wrote(*write(found, f" {as_given(args)}".rstrip(), args.output))
        made.tell(announce, found, **finite(found.record))
    return 0


def finite(content: Any) -> Any:
    """The same with None for what is no finite number."""
    if isinstance(content, dict):
        return {name: finite(value) for name, value in content.items()}
    if isinstance(content, list):
        return [finite(value) for value in content]
    return None if isinstance(content, float) and not isfinite(content) else content
