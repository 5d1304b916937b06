"""`driveline bound`: what no controller can beat, beside what ours reaches."""

import argparse
from typing import Any

from ..base.errors import DrivelineError
from ..loop.built_fmus import built
from ..loop.places import PLACES, PLANTS
from .options import add_fmus, add_output, add_printing
from .printing import Printer

DESCRIPTION = """\
Computes the best torque that is possible on the design model, with full knowledge of car, state and demand, at the same
response to the driver as the controller has: 90 % of the way at the same sample, no more torque withheld, settled no
later, within the same limits. By convex programmes for given contacts of the teeth, over the switching times on a grid;
a lower bound follows by duality, and the nonlinear design model verifies every optimum. docs/bound.md says what is
proven.

The table has how much worse the controller is than the smallest possible worst ratio of overshoot, gear torque rms,
jerk and impact speed. The output folder gets the page bound.md, bound.json (what made it) and, in its folder figures,
the torques. Needs the extra `bound`.
"""

EXAMPLES = """\
examples:
  driveline bound                                     all manoeuvres, in some minutes
  driveline bound --manoeuvre tipin15 --output results/bound15
  driveline bound --parameters my_gains.toml --output results/mine
  driveline bound --controller SpeedWashout --json > bound.json
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    from ...fmus.building.options import add_parameter_files
    from ..studies.bound.bounded_manoeuvres import BOUNDED_MANOEUVRES

    parser.add_argument(
        "--manoeuvre",
        action="append",
        choices=BOUNDED_MANOEUVRES,
        metavar="NAME",
        help=f"only this one: {', '.join(BOUNDED_MANOEUVRES)} (repeatable)",
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
    add_output(parser, "results/bound", "the page and the figure", of_a_run=True)
    add_printing(parser, table=True)


def run(args: argparse.Namespace) -> int:
    from ...fmus.building.parameter_files import read_files
    from ...fmus.errors import ParameterFileError
    from ..studies.bound.bounded_manoeuvres import BOUNDED_MANOEUVRES

    names = list(dict.fromkeys(args.manoeuvre or BOUNDED_MANOEUVRES))
    try:
        values = read_files(args.vehicle, args.parameters)
    except ParameterFileError as refusal:
        raise DrivelineError(str(refusal)) from refusal
    plant = PLANTS[0]
    build = built(plant, args.fmus, controller=args.controller)
    # here and not above: mistakes and help are answered without them
    from ..design.design_trials import loop_parameters
    from ..simulation.provenance import recorded
    from ..simulation.simulate import looped
    from ..studies.bound.bound_report import announce, record, write
    from ..studies.bound.bounds import all_bounded
    from .settings import distinguishing

    given: dict[str, Any] = {
        "folder": args.fmus,
        "build": build,
        "controller": args.controller,
        "parameters": loop_parameters(values, plant, args.controller),
    }
    system = looped(plant, given)
    same = {"manoeuvres": names, plant: distinguishing(given | {"seed": 1, "mapping": {}}, system, None)}
    made_by, first = args.output / "bound.json", args.output / "bound.md"
    out = Printer(args)
    with recorded(made_by, same, {plant: system}, [args.vehicle, args.parameters], [first], args.replace) as made:
        found = all_bounded(names, given)
        made.begin()
        made.files += write(found, args.controller, _as_given(args), args.output)
    if not out.silent:
        announce(found, args.controller)
    for file in (*made.files, made_by):
        out.say(f"written: {file}")
    out.document({"manoeuvres": [record(each) for each in found], "files": made.files})
    return 0


def _as_given(args: argparse.Namespace) -> str:
    """The options that are not the usual ones."""
    options = [
        *(("manoeuvre", name) for name in args.manoeuvre or ()),
        ("controller", None if args.controller == PLACES["controller"][0] else args.controller),
        ("vehicle", args.vehicle),
        ("parameters", args.parameters),
    ]
    return "".join(f" --{name} {value}" for name, value in options if value is not None)
