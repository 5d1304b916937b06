"""Drives the loop through manoeuvres in which a signal of the controller fails, or the wheels lock or spin on ice, and
judges each run: is the torque reference finite and limited, does the status say what is true, is everything as before
0.5 s after the fault, is no oscillation left, does the drive train swing no more than without control?

What fails, when, how much and for how long follows from the seed and the number of a case; half of the cases have two
faults at a time. Beside each run stand two more with the same noise: without the fault, and without control. 840 cases
have every kind of fault alone, in every situation, on both plants (420 on one); of the roads it takes 2664 (1332), of
the starts 280 (140). The same command goes on where it was stopped. --case runs one case again, and writes its signals
and draws them. The exit code is 1 if a case is not clean.

examples:
  driveline faults                                        1000 cases, both plants
  driveline faults --cases 10000 --seed 2 --plant ValidationVehicle
  driveline faults --campaign roads --output results/roads  on ice, hills, under ABS; faults that stay, late frames
  driveline faults --case 806                             one of them, drawn
  driveline faults --controller my_controller.fmu         how good is mine?
"""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from toolground.arguments import option, record
from toolground.printing import JsonPrinting

from ..loop.places import NATIVE
from .jobs import Job, campaign_job, distinguishing, job
from .options import Campaign, case, cases, controller, output, seed
from .settings import caption, plants_loops, say_unknowns

if TYPE_CHECKING:
    from fmuloop.wiring import Fit

    from ..studies.faults.fault_campaign import Outcome
    from ..studies.faults.fault_injection import FaultRunner

MOST = 1_000_000


@record
class Arguments(Campaign, JsonPrinting):
    cases: int = cases(1000, MOST)
    case: int | None = case(MOST, "only the case of this number, with a figure")
    campaign: str | None = option(
        None,
        "dry: on a dry road, where ice is a fault too (default); roads: slippery ones, hills, ABS, late frames; "
        "starts: wrong first samples while the car drives",
        choices=("dry", "roads", "starts"),
    )
    controller: str = controller()
    seed: int = option(1, "of the faults and the sensor noise (default: %(default)s)", seed)
    output: Path = output("results/faults", "the cases and the figures")


def run(args: Arguments) -> int:
    given = plants_loops(args)
    # here and not above: mistakes and help are answered without them
    from fmuloop.wiring import fit

    from ...fmus.catalogue import SIGNAL_FAULTS
    from ..loop.built_fmus import made_if_missing
    from ..studies.faults.fault_injection import FaultRunner, with_faults

    injector = made_if_missing(SIGNAL_FAULTS, args.fmus, NATIVE)
    runner = FaultRunner(injector, {str(each.settings.plant): each for each in given.values()})
    same: dict[str, Any] = {name: distinguishing(each) for name, each in given.items()}
    tried = {name: fit(with_faults(each.system, injector, each.settings.topology)) for name, each in given.items()}
    return (_all if args.case is None else _one)(args, runner, same, tried)


def _all(args: Arguments, runner: "FaultRunner", same: dict[str, Any], fits: "dict[str, Fit]") -> int:
    from fmuloop.executors import dask_executor

    from ..studies.faults.fault_campaign import campaign, table
    from ..studies.faults.fault_campaign import distinguishing as of_the_cases
    from ..studies.faults.fault_cases import PLANS
    from ..studies.faults.fault_report import write

    plan = PLANS[args.campaign or "dry"]
    record, cases = args.output / "faults.json", args.output / "faults.csv"
    same |= of_the_cases(runner, args.seed, plan)
    with (
        campaign_job(args, record, cases, table(args.seed, runner.plants, plan), same, fits) as (made, archive),
        dask_executor(args.scheduler) as executor,
    ):
        outcomes = campaign(runner, range(1, args.cases + 1), args.seed, archive, executor=executor, plan=plan)
        archive.sort(lambda case: case.number)
        made.wrote(*write(outcomes, args.output))
        say_unknowns(args)
        return _tell(made, outcomes, runner)


def _one(args: Arguments, runner: "FaultRunner", same: dict[str, Any], fits: "dict[str, Fit]") -> int:
    """One case again."""
    from ..studies.faults.fault_cases import PLANS
    from ..studies.faults.fault_report import write_case

    assert args.case is not None
    plan = PLANS[args.campaign or "dry"]
    record, signals = (args.output / f"case_{args.case}{ending}" for ending in (".json", ".csv"))
    with job(args, record, same | {"case": args.case}, fits, [signals]) as made:
        made.begin()
        outcome, files = write_case(args.case, args.seed, runner, args.output, case_caption(args), plan)
        made.wrote(*files)
        args.say(f"case {outcome.case}")
        return _tell(made, [outcome], runner)


def case_caption(args: Arguments) -> str:
    """What the figure of a case says of the options: the campaign too, as each counts its own cases."""
    campaign = f"--campaign {args.campaign}" if args.campaign not in (None, "dry") else ""
    return f"{campaign} {caption(args)}".strip()


def _tell(made: Job[Any], outcomes: "Sequence[Outcome]", runner: "FaultRunner") -> int:
    """Writes the report if one is asked for, and says what came of the cases; returns the exit code."""
    from ..studies.faults.fault_report import announce

    for provenance, path in made.reports():
        from ..studies.faults import fault_report_html

        fault_report_html.report(outcomes, runner, provenance, path)
    made.tell(announce, outcomes, cases=[outcome.record for outcome in outcomes])
    return int(any(outcome.failed for outcome in outcomes))
