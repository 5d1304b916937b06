"""`driveline faults`: the controller under faults of its signals and on ice, case after case."""

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..base.known_names import require_different
from ..loop.built_fmus import built, made_if_missing
from ..loop.places import NATIVE, PLANTS
from ..views.html.report_page import require_report
from .options import add_loop, add_output, add_plant, add_printing, add_report, count
from .printing import Printer
from .settings import as_given, blocks, caption, distinguishing, settings

if TYPE_CHECKING:
    from ..cosimulation.system import System
    from ..studies.faults.fault_campaign import Outcome
    from ..studies.faults.fault_injection import FaultRunner

DESCRIPTION = """\
Drives the loop through manoeuvres in which a signal of the controller fails, or the wheels lock or spin on ice, and
judges each run: is the torque reference finite and limited, does the status say what is true, is everything as before
0.5 s after the fault, is no oscillation left, does the drive train swing no more than without control?

What fails, when, how much and for how long follows from the seed and the number of a case; half of the cases have two
faults at a time. Beside each run stand two more with the same noise: without the fault, and without control. One matrix
of kinds of faults and judges is printed, for single faults and pairs together; cells count the runs that are not clean.

The output folder gets faults.csv (all cases with what was measured), the page faults.md, faults.json (what made them)
and, in its folder figures, the matrices as figures. The same command goes on where it was stopped. --case runs one case
again, and writes its signals and draws them.
"""

EXAMPLES = """\
examples:
  driveline faults                                        1000 cases, both plants
  driveline faults --cases 10000 --seed 2
  driveline faults --plant ValidationVehicle --cases 300
  driveline faults --case 806                             one of them, drawn
  driveline faults --controller my_controller.fmu         how good is mine?
  driveline faults --json > faults.json
  driveline faults --scheduler tcp://10.0.0.1:8786        on a Dask cluster

exit code: 1 if a case is not clean
"""

MOST_CASES = 1_000_000


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--cases", type=_number, default=1000, metavar="COUNT", help="how many (default: %(default)s)")
    parser.add_argument("--case", type=_number, metavar="NUMBER", help="only the case of this number, with a figure")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="of a Dask cluster that runs the cases")
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
    from ..simulation.simulate import looped
    from ..studies.faults.fault_injection import FaultRunner, with_faults

    with made_if_missing(FMU, args.fmus, NATIVE) as injector:
        runner, systems = FaultRunner(injector, given), {plant: looped(plant, given[plant]) for plant in plants}
        same = {Path(plant).stem: distinguishing(given[plant], systems[plant], None) for plant in plants}
        tried = {Path(plant).stem: with_faults(system, injector) for plant, system in systems.items()}
        return (_all if args.case is None else _one)(args, runner, same, tried)


def _all(args: argparse.Namespace, runner: "FaultRunner", same: dict[str, Any], systems: dict[str, "System"]) -> int:
    from ..simulation.case_archive import resumable
    from ..studies.faults.fault_archive import table
    from ..studies.faults.fault_campaign import campaign
    from ..studies.faults.fault_campaign import distinguishing as of_the_cases
    from ..studies.faults.fault_report import write

    cases, record = args.output / "faults.csv", args.output / "faults.json"
    same, kept = same | of_the_cases(runner, args.seed), table(args.seed, runner.plants)
    with resumable(cases, kept, record, same, systems, _read(args), _report(args), args.replace) as made:
        outcomes = campaign(runner, range(1, args.cases + 1), args.seed, made.archive, scheduler=args.scheduler)
        made.archive.sort(lambda case: case.number)
        made.files += write(outcomes, f" {as_given(args)}", args.output)
        made.files += _reported(args, outcomes, runner, made.provenance)
    return _said(args, outcomes, [*made.files, record])


def _one(args: argparse.Namespace, runner: "FaultRunner", same: dict[str, Any], systems: dict[str, "System"]) -> int:
    """One case again."""
    from ..simulation.provenance import content, recorded
    from ..studies.faults.fault_report import write_case

    name, read, same = f"case_{args.case}", _read(args), same | {"case": args.case}
    record, results = args.output / f"{name}.json", [args.output / f"{name}.csv", *_report(args)]
    with recorded(record, same, systems, read, results, args.replace) as made:
        made.begin()
        outcome, files = write_case(args.case, args.seed, runner, args.output, caption(args))
        Printer(args).say(f"case {outcome.case}")
        made.files += [*files, *_reported(args, [outcome], runner, content(same, made.fits, [], read))]
    return _said(args, [outcome], [*made.files, record])


def _said(args: argparse.Namespace, outcomes: Sequence["Outcome"], files: Sequence[Path]) -> int:
    """Says what came of the cases, and which files were written; returns the exit code."""
    from ..studies.faults.fault_report import announce

    out = Printer(args)
    if not out.silent:
        announce(outcomes)
    for file in files:
        out.say(f"written: {file}")
    out.document({"cases": [outcome.record for outcome in outcomes], "files": files[:-1]})
    return int(any(outcome.failed for outcome in outcomes))


def _read(args: argparse.Namespace) -> list[Path | None]:
    return [args.vehicle, args.parameters]


def _report(args: argparse.Namespace) -> list[Path]:
    return [args.report] if args.report else []


def _reported(
    args: argparse.Namespace, outcomes: Sequence["Outcome"], runner: "FaultRunner", provenance: Any
) -> list[Path]:
    """Writes the report if one is asked for; returns the file."""
    for path in _report(args):
        from ..studies.faults import fault_report_html

        fault_report_html.report(outcomes, runner, provenance, path)
    return _report(args)
