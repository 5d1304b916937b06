"""`driveline analyse`: how stable the loop is, what it depends on, and how good the estimate is."""

import argparse
from collections.abc import Iterable
from math import isfinite
from typing import Any

from ..base.errors import DrivelineError
from ..loop.built_fmus import built
from ..loop.places import PLACES, PLANTS
from .options import add_fmus, add_output, add_printing
from .printing import Printer

DESCRIPTION = """\
Analyses the loop with a controller of the catalogue: gain, phase and delay margins and M_s with the true delays, Bode
and Nyquist figures, the poles over speed, stiffness, inertia and dead time, the describing function of the backlash and
the limit cycles that it excludes, the error of the estimate and its time in the wrong contact mode, and the sensitivity
of the metrics to each parameter of car and controller.

The linear model comes from the functions of the blocks themselves, differentiated with the teeth in contact. The table
of margins is printed; the output folder gets the page analysis.md, sensitivity.csv, analysis.json (what made them) and,
in its folder figures, the figures.
"""

EXAMPLES = """\
examples:
  driveline analyse
  driveline analyse --controller SpeedWashout --output results/washout
  driveline analyse --vehicle examples/cars/van.toml --parameters van_gains.toml --output results/van
  driveline analyse --plant TwoMassDriveline --json > analysis.json
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    from ...fmus.building.options import add_parameter_files

    parser.add_argument(
        "--plant", action="append", choices=PLANTS, metavar="NAME", help=f"only this plant: {' or '.join(PLANTS)}"
    )
    names = PLACES["controller"]
    parser.add_argument(
        "--controller",
        choices=names,
        metavar="NAME",
        default=names[0],
        help=f"damping control: {', '.join(names)} (default: %(default)s)",
    )
    add_parameter_files(parser)
    add_fmus(parser)
    add_output(parser, "results/analyse", "the page, the table of sensitivities and the figures", of_a_run=True)
    add_printing(parser, table=True)


def run(args: argparse.Namespace) -> int:
    from ...fmus.building.parameter_files import read_files
    from ...fmus.errors import ParameterFileError

    plants = list(dict.fromkeys(args.plant or PLANTS))
    try:
        values = read_files(args.vehicle, args.parameters)
    except ParameterFileError as refusal:
        raise DrivelineError(str(refusal)) from refusal
    builds = {plant: built(plant, args.fmus, controller=args.controller) for plant in plants}
    # here and not above: mistakes and help are answered without them
    from ..design.design_trials import loop_parameters
    from ..simulation.provenance import recorded
    from ..simulation.simulate import looped
    from ..studies.margins.analysis_report import announce, write
    from ..studies.margins.loop_analysis import analyse
    from .settings import distinguishing

    given: dict[str, dict[str, Any]] = {
        plant: {
            "folder": args.fmus,
            "build": build,
            "controller": args.controller,
            "parameters": loop_parameters(values, plant, args.controller),
        }
        for plant, build in builds.items()
    }
    systems = {plant: looped(plant, given[plant]) for plant in plants}
    same = {p: distinguishing(given[p] | {"seed": 1, "mapping": {}}, systems[p], None) for p in plants}
    record, first = args.output / "analysis.json", args.output / "analysis.md"
    out = Printer(args)
    with recorded(record, same, systems, [args.vehicle, args.parameters], [first], args.replace) as made:
        found = analyse(plants, args.controller, given)
        made.begin()
        made.files += write(found, _as_given(args), args.output)
    if not out.silent:
        announce(found)
    for file in (*made.files, record):
        out.say(f"written: {file}")
    out.document(finite(found.record) | {"files": made.files})
    return 0


def _as_given(args: argparse.Namespace) -> str:
    """The options that are not the usual ones."""
    options: Iterable[tuple[str, Any]] = [
        *(("plant", plant) for plant in args.plant or ()),
        ("controller", None if args.controller == PLACES["controller"][0] else args.controller),
        ("vehicle", args.vehicle),
        ("parameters", args.parameters),
    ]
    return "".join(f" --{name} {value}" for name, value in options if value is not None)


def finite(content: Any) -> Any:
    """The same with None for what is no finite number."""
    if isinstance(content, dict):
        return {name: finite(value) for name, value in content.items()}
    if isinstance(content, list):
        return [finite(value) for value in content]
    return None if isinstance(content, float) and not isfinite(content) else content
