"""Computes the best torque that is possible on the design model, with full knowledge of car, state and demand, at the
same response to the driver as the controller has: 90 % of the way at the same sample, no more torque withheld, settled
no later, within the same limits. By convex programmes for given contacts of the teeth, over the switching times on a
grid; a lower bound follows by duality, and the nonlinear design model verifies every optimum. docs/bound.md says what
is proven.

The table has how much worse the controller is than the smallest possible worst ratio of overshoot, gear torque rms,
jerk and impact speed. The output folder gets the page bound.md, bound.json (what made it) and, in its folder figures,
the torques. Needs the extra `bound`.

examples:
  driveline study bound                        all manoeuvres; each takes some minutes on a core
  driveline study bound --manoeuvre tipin15 --output results/bound15
  driveline study bound --parameters my_gains.toml --output results/mine
  driveline study bound --controller SpeedWashout --json > bound.json
"""

import argparse

from ..loop.places import PLANTS
from .course import job
from .options import add_controller, add_fmus, add_output, add_printing
from .settings import as_given, distinguishing, settings_of_ours


def add_arguments(parser: argparse.ArgumentParser) -> None:
    from ..studies.bound.bounded_manoeuvres import BOUNDED_MANOEUVRES

    parser.add_argument(
        "--manoeuvre",
        action="append",
        choices=BOUNDED_MANOEUVRES,
        metavar="NAME",
        help=f"only this one: {', '.join(BOUNDED_MANOEUVRES)} (repeatable)",
    )
    add_controller(parser)
    add_fmus(parser)
    add_output(parser, "results/bound", "the page and the figure", of_a_run=True)
    add_printing(parser, table=True)


def run(args: argparse.Namespace) -> int:
    from ..studies.bound.bounded_manoeuvres import BOUNDED_MANOEUVRES

    names, given = list(dict.fromkeys(args.manoeuvre or BOUNDED_MANOEUVRES)), settings_of_ours(args, PLANTS[:1])
    # here and not above: mistakes and help are answered without them
    from ..studies.bound.bound_report import announce, record, write
    from ..studies.bound.bounds import all_bounded

    same = {"manoeuvres": names, **{plant: distinguishing(each) for plant, each in given.items()}}
    with job(args, args.output / "bound.json", same, given, [args.output / "bound.md"]) as made:
        found = all_bounded(names, given[PLANTS[0]])
        made.begin()
        made.wrote(*write(found, args.controller, f" {as_given(args)}".rstrip(), args.output))
        made.tell(announce, found, args.controller, manoeuvres=[record(each) for each in found])
    return 0
