"""`driveline faults`: the controller under faults of its signals and on ice, case after case."""

import argparse
from pathlib import Path
from typing import Any

from ..base.known_names import require_different
from ..loop.built_fmus import built, made_if_missing
from ..loop.places import NATIVE, PLANTS
from ..views.html.report_page import require_report
from .options import add_loop, add_output, add_plant, add_printing, add_report, count
from .printing import Printer
from .settings import as_given, blocks, caption, distinguishing, settings

DESCRIPTION = """\
Drives the loop through manoeuvres in which a signal of the controller fails, or the wheels lock or spin on ice, and
judges each run: is the torque reference finite and limited, does the status say what is true, is everything as before
0.5 s after the fault, is no oscillation left, does the drive train swing no more than without control?

What fails, when, how much and for how long follows from the seed and the number of a case; half of the cases have two
faults at a time. Beside each run stand two more with the same noise: without the fault, and without control. One matrix
of kinds of faults and judges is printed, for single faults and pairs together; cells count the runs that are not clean.

The output folder gets faults.csv (all cases with what was measured), the page faults.md, faults.json (what made them)
and, in its folder figures, the matrices as figures. --case runs one case again, and writes its signals and draws them.
"""

EXAMPLES = """\
examples:
  driveline faults                                        1000 cases, both plants
  driveline faults --cases 10000 --seed 2
  driveline faults --plant ValidationVehicle --cases 300
  driveline faults --case 806                             one of them, drawn
  driveline faults --controller my_controller.fmu         how good is mine?
  driveline faults --json > faults.json

exit code: 1 if a case is not clean
"""

MOST_CASES = 1_000_000


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--cases", type=_number, default=1000, metavar="COUNT", help="how many (default: %(default)s)")
    parser.add_argument("--case", type=_number, metavar="NUMBER", help="only the case of this number, with a figure")
    add_plant(parser, several=True)
    add_loop(parser)
    add_output(parser, "results/faults", "the cases, the page and the figures", of_a_run=True)
    add_report(parser)
    add_printing(parser, table=True)


def _number(text: str) -> int:
    return count(text, 1, MOST_CASES)


def run(args: argparse.Namespace) -> int:
    require_report(args.report)
    plants = list(dict.fromkeys(args.plant or PLANTS))
    require_different(plants)
    given = {plant: settings(args, plant, built(plant, args.fmus, args.build, **blocks(args))) for plant in plants}
    # here and not above: mistakes and help are answered without them
    from ...fmus.signal_faults import FMU
    from ..simulation.provenance import content, recorded
    from ..simulation.simulate import looped
    from ..studies.faults.fault_campaign import campaign
    from ..studies.faults.fault_injection import FaultRunner, with_faults
    from ..studies.faults.fault_report import announce, write, write_case

    out = Printer(args)
    systems = {plant: looped(plant, given[plant]) for plant in plants}
    same: dict[str, Any] = {Path(plant).stem: distinguishing(given[plant], systems[plant], None) for plant in plants}
    same |= {"cases": args.cases} if args.case is None else {"case": args.case}
    name, first = ("faults", "faults.csv") if args.case is None else (f"case_{args.case}", f"case_{args.case}.csv")
    record = args.output / f"{name}.json"
    report = [args.report] if args.report else []
    with made_if_missing(FMU, args.fmus, NATIVE) as injector:
        tried = {Path(plant).stem: with_faults(system, injector) for plant, system in systems.items()}
        read = [args.vehicle, args.parameters]
        with recorded(record, same, tried, read, [args.output / first, *report], args.replace) as made:
            if args.case is not None:
                made.begin()
                outcome, files = write_case(args.case, args.seed, injector, given, args.output, caption(args))
                outcomes = [outcome]
                out.say(f"case {outcome.case}")
            else:
                outcomes = campaign(range(1, args.cases + 1), args.seed, injector, given)
                made.begin()
                files = write(outcomes, f" {as_given(args)}", args.output)
            if args.report:
                from ..studies.faults import fault_report_html

                fault_report_html.report(
                    outcomes, FaultRunner(injector, given), content(same, made.fits, [], read), args.report
                )
            made.files += [*files, *report]
    if not out.silent:
        announce(outcomes)
    for file in (*made.files, record):
        out.say(f"written: {file}")
    out.document({"cases": [outcome.record for outcome in outcomes], "files": made.files})
    return int(any(outcome.failed for outcome in outcomes))
