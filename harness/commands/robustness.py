"""Draws cars with their sensors from the box of parameters (docs/results.md), of which no controller is told, and
drives each through a tip-in, a tip-out and a launch with every controller, with the same noise. A table for each plant
tells which share of the runs is bounded and quiet, which is good, and what half and 95 % of the runs do not exceed.

The same command goes on where it was stopped. --case runs one draw again, and writes its signals and draws them.

examples:
  driveline robustness                                       300 draws, both plants, all controllers
  driveline robustness --controller DampingController --parameters my_gains.toml --output results/mine
  driveline robustness --case 17                             one of them, drawn
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from toolground.arguments import option, record
from toolground.printing import JsonPrinting

from .jobs import Job, campaign_job, distinguishing, job
from .options import Campaign, case, cases, controllers, output, seed
from .settings import all_loops, caption, say_unknowns

if TYPE_CHECKING:
    from fmuloop.wiring import Fit

    from ..studies.robustness.case_runs import CaseRunner
    from ..studies.robustness.outcome import Outcome

MOST = 100_000


@record
class Arguments(Campaign, JsonPrinting):
    cases: int = cases(300, MOST)
    case: int | None = case(MOST, "only the draw of this number, with figures")
    controller: tuple[str, ...] = controllers("all of these")
    seed: int = option(1, "of the cars and the sensor noise (default: %(default)s)", seed)
    output: Path = output("results/robustness", "the runs and the figures")


def run(args: Arguments) -> int:
    given = all_loops(args, args.plant, args.controller)
    # here and not above: mistakes and help are answered without them
    from ..studies.robustness.case_runs import CaseRunner
    from ..studies.robustness.robustness_campaign import distinguishing as of_the_draws

    runner, loops = CaseRunner(given, args.seed), {" with ".join(key): each for key, each in given.items()}
    same = of_the_draws(runner) | {name: distinguishing(each) for name, each in loops.items()}
    fits = {name: each.fit for name, each in loops.items()}
    return (_all if args.case is None else _one)(args, runner, same, fits)


def _all(args: Arguments, runner: "CaseRunner", same: dict[str, Any], fits: "Mapping[str, Fit]") -> int:
    from fmuloop.executors import dask_executor

    from ..studies.robustness.robustness_campaign import RUNS, campaign, order
    from ..studies.robustness.robustness_report import write

    record, runs = args.output / "robustness.json", args.output / "runs.csv"
    with (
        campaign_job(args, record, runs, RUNS, same, fits) as (made, archive),
        dask_executor(args.scheduler) as executor,
    ):
        outcomes = campaign(runner, range(1, args.cases + 1), archive, executor=executor)
        archive.sort(order(runner))
        made.wrote(*write(outcomes, runner, caption(args), args.output))
        say_unknowns(args)
        _tell(made, outcomes, runner)
    return 0


def _one(args: Arguments, runner: "CaseRunner", same: dict[str, Any], fits: "Mapping[str, Fit]") -> int:
    """One draw again."""
    from ..studies.robustness.draws import draw
    from ..studies.robustness.robustness_campaign import campaign
    from ..studies.robustness.robustness_report import write_draw

    assert args.case is not None
    with job(args, args.output / f"draw_{args.case}.json", same | {"case": args.case}, fits) as made:
        args.say(f"draw {draw(args.case, args.seed)}")
        outcomes = campaign(runner, [args.case])
        made.begin()
        made.wrote(*write_draw(outcomes, runner, caption(args), args.output))
        _tell(made, outcomes, runner)
    return 0


def _tell(made: Job[Any], outcomes: Sequence["Outcome"], runner: "CaseRunner") -> None:
    from ..studies.robustness import robustness_report_html
    from ..studies.robustness.robustness_report import announce
    from ..studies.robustness.summary import summaries

    for provenance, path in made.reports():
        robustness_report_html.report(outcomes, runner, provenance, path)
    made.tell(announce, outcomes, summaries=[summary.record for summary in summaries(outcomes)])
