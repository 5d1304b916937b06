"""Drives the loop through manoeuvres in which a signal of the controller fails, or the wheels lock or spin on ice, and
judges each run: is the torque reference finite and limited, does the status say what is true, is everything as before
0.5 s after the fault, is no oscillation left, does the drive train swing no more than without control?

What fails, when, how much and for how long follows from the seed and the number of a case; half of the cases have two
faults at a time. Beside each run stand two more with the same noise: without the fault, and without control. Of the
cases that are not clean a matrix of kinds of faults and judges is printed, for single faults and pairs together.

840 cases have every kind of fault alone, in every situation, on both plants (420 on one); of the roads it takes 2664
(1332). Of fewer cases the summary names the kinds that no case has alone.

The output folder gets faults.csv (all cases with what was measured), the page faults.md, faults.json (what made them)
and, in its folder figures, the matrices as figures. The same command goes on where it was stopped. --case runs one case
again, and writes its signals and draws them.

examples:
  driveline faults                                        1000 cases, both plants
  driveline faults --cases 10000 --seed 2
  driveline faults --plant ValidationVehicle --cases 300
  driveline faults --campaign roads --output results/roads  on ice, hills, under ABS; faults that stay, late frames
  driveline faults --case 806                             one of them, drawn
  driveline faults --controller my_controller.fmu         how good is mine?
  driveline faults --json > faults.json
  driveline faults --scheduler tcp://10.0.0.1:8786        on a Dask cluster

exit code: 1 if a case is not clean
"""

import argparse
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ..loop.built_fmus import made_if_missing
from ..loop.places import NATIVE
from ..loop.settings import loop
from ..views.html.report_page import require_report
from .course import Job, campaign_job, job
from .options import add_cases, add_loop, add_output, add_plant, add_printing, add_report
from .settings import as_given, caption, distinguishing, settings_of_plants

if TYPE_CHECKING:
    from ..cosimulation.system import System
    from ..studies.faults.fault_campaign import Outcome
    from ..studies.faults.fault_injection import FaultRunner


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_cases(parser, 1000, 1_000_000, "only the case of this number, with a figure")
    parser.add_argument(
        "--campaign",
        choices=("dry", "roads"),
        help="which cases (default: dry); dry: on a dry road, where ice that makes wheels lock or spin is a fault too; "
        "roads: on roads that are slippery themselves, on hills, under ABS, with frames that are late",
    )
    add_plant(parser, several=True)
    add_loop(parser, drawn="the faults and the sensor noise")
    add_output(parser, "results/faults", "the cases, the page and the figures", of_a_run=True)
    add_report(parser)
    add_printing(parser, table=True)


def run(args: argparse.Namespace) -> int:
    require_report(args.report)
    given = settings_of_plants(args)
    # here and not above: mistakes and help are answered without them
    from ...fmus.catalogue import SIGNAL_FAULTS
    from ..studies.faults.fault_injection import FaultRunner, with_faults

    injector = made_if_missing(SIGNAL_FAULTS, args.fmus, NATIVE)
    runner = FaultRunner(injector, given)
    same: dict[str, Any] = {each.plant_name: distinguishing(each) for each in given.values()}
    tried = {each.plant_name: with_faults(loop(each), injector) for each in given.values()}
    return (_all if args.case is None else _one)(args, runner, same, tried)


def _all(args: argparse.Namespace, runner: "FaultRunner", same: dict[str, Any], systems: "dict[str, System]") -> int:
    from ..studies.faults.fault_campaign import campaign, table
    from ..studies.faults.fault_campaign import distinguishing as of_the_cases
    from ..studies.faults.fault_cases import PLANS
    from ..studies.faults.fault_report import write

    plan = PLANS[args.campaign or "dry"]
    record, cases = args.output / "faults.json", args.output / "faults.csv"
    same |= of_the_cases(runner, args.seed, plan)
    with campaign_job(args, record, cases, table(args.seed, runner.plants, plan), same, systems) as (made, archive):
        outcomes = campaign(runner, range(1, args.cases + 1), args.seed, archive, scheduler=args.scheduler, plan=plan)
        archive.sort(lambda case: case.number)
        made.wrote(*write(outcomes, f" {as_given(args)}", args.output))
        return _tell(made, outcomes, runner)


def _one(args: argparse.Namespace, runner: "FaultRunner", same: dict[str, Any], systems: "dict[str, System]") -> int:
    """One case again."""
    from ..studies.faults.fault_cases import PLANS
    from ..studies.faults.fault_report import write_case

    plan = PLANS[args.campaign or "dry"]
    record, signals = (args.output / f"case_{args.case}{ending}" for ending in (".json", ".csv"))
    with job(args, record, same | {"case": args.case}, systems, [signals]) as made:
        made.begin()
        outcome, files = write_case(args.case, args.seed, runner, args.output, case_caption(args), plan)
        made.wrote(*files)
        made.out.say(f"case {outcome.case}")
        return _tell(made, [outcome], runner)


def case_caption(args: argparse.Namespace) -> str:
    """What the figure of a case says of the options: the campaign too, as each counts its own cases."""
    campaign = f"--campaign {args.campaign}" if args.campaign not in (None, "dry") else ""
    return f"{campaign} {caption(args)}".strip()


def _tell(made: Job, outcomes: "Sequence[Outcome]", runner: "FaultRunner") -> int:
    """Writes the report if one is asked for, and says what came of the cases; returns the exit code."""
    from ..studies.faults.fault_report import announce

    for provenance, path in made.reports():
        from ..studies.faults import fault_report_html

        fault_report_html.report(outcomes, runner, provenance, path)
    made.tell(announce, outcomes, cases=[outcome.record for outcome in outcomes])
    return int(any(outcome.failed for outcome in outcomes))
