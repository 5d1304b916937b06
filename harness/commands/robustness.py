"""`driveline robustness`: the Monte-Carlo of cars and sensors, the same draws for every controller."""

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..loop.places import PLACES, PLANTS
from ..views.html.report_page import require_report
from .options import add_loop, add_output, add_plant, add_printing, add_report, count
from .printing import Printer
from .settings import as_given, caption, distinguishing, settings_of_each

if TYPE_CHECKING:
    from ..studies.robustness.case_runs import CaseRunner, Given
    from ..studies.robustness.outcome import Outcome

DESCRIPTION = """\
Draws cars with their sensors from the box of parameters (docs/robustness.md), of which no controller is told, and
drives each through a tip-in, a tip-out and a launch with every controller, with the same noise. A table for each plant
tells which share of the runs is bounded and quiet, which is good, and what half and 95 % of the runs do not exceed.

The output folder gets runs.csv (every run with all metrics), draws.csv, summary.csv, the page robustness.md,
robustness.json (what made them) and, in its folder figures, the distributions and the worst draws of the first
controller. The same command goes on where it was stopped. --case runs one draw again, and writes its signals and draws
them.
"""

EXAMPLES = """\
examples:
  driveline robustness                                       300 draws, both plants, all controllers
  driveline robustness --cases 1000 --plant ValidationVehicle
  driveline robustness --controller DampingController --parameters my_gains.toml --output results/mine
  driveline robustness --case 17                             one of them, drawn
  driveline robustness --scheduler tcp://10.0.0.1:8786       on a Dask cluster
"""

MOST_CASES = 100_000


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--cases", type=_number, default=300, metavar="COUNT", help="how many (default: %(default)s)")
    parser.add_argument("--case", type=_number, metavar="NUMBER", help="only the draw of this number, with figures")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="of a Dask cluster that runs the cases")
    add_plant(parser, several=True)
    add_loop(parser, several={"controller": "all of these"})
    add_output(parser, "results/robustness", "the runs, the page and the figures", of_a_run=True)
    add_report(parser)
    add_printing(parser, table=True)


def _number(text: str) -> int:
    return count(text, 1, MOST_CASES)


def run(args: argparse.Namespace) -> int:
    # here and not above: mistakes and help are answered without them
    from ..base.known_names import require_different
    from ..studies.drives.replay import by_name
    from ..studies.robustness.case_runs import CaseRunner

    require_report(args.report)
    plants = list(dict.fromkeys(args.plant or PLANTS))
    require_different(plants)
    controllers = by_name(args.controller or PLACES["controller"])
    given = {
        (Path(plant).stem, name): (plant, of_each)
        for plant in plants
        for name, of_each in settings_of_each(args, plant, controllers).items()
    }
    runner = CaseRunner(given, args.seed)
    return _one(args, runner, given) if args.case is not None else _all(args, runner, given)


def _all(args: argparse.Namespace, runner: "CaseRunner", given: "Given") -> int:
    from ..simulation.case_archive import resumable
    from ..studies.robustness.campaign_archive import RUNS
    from ..studies.robustness.robustness_campaign import campaign, order
    from ..studies.robustness.robustness_report import announce, write
    from ..studies.robustness.summary import summaries

    out, same, systems = Printer(args), _distinguishing(runner, given), _systems(given)
    record, runs, read = args.output / "robustness.json", args.output / "runs.csv", [args.vehicle, args.parameters]
    with resumable(runs, RUNS, record, same, systems, read, _report(args), args.replace) as made:
        outcomes = campaign(runner, range(1, args.cases + 1), made.archive, scheduler=args.scheduler)
        made.archive.sort(order(runner))
        made.files += write(outcomes, runner, _as_given(args), caption(args), args.output)
        made.files += _reported(args, outcomes, runner, made.provenance)
    if not out.silent:
        announce(outcomes)
    for file in (*made.files, record):
        out.say(f"written: {file}")
    out.document({"summaries": [summary.record for summary in summaries(outcomes)], "files": made.files})
    return 0


def _one(args: argparse.Namespace, runner: "CaseRunner", given: "Given") -> int:
    """One draw again."""
    from ..simulation.provenance import content, recorded
    from ..studies.robustness.draws import draw
    from ..studies.robustness.robustness_campaign import campaign
    from ..studies.robustness.robustness_report import announce, write_draw
    from ..studies.robustness.summary import summaries

    out, name, read = Printer(args), f"draw_{args.case}", [args.vehicle, args.parameters]
    record, same = args.output / f"{name}.json", _distinguishing(runner, given) | {"case": args.case}
    with recorded(record, same, _systems(given), read, _report(args), args.replace) as made:
        out.say(f"draw {draw(args.case, args.seed)}")
        outcomes = campaign(runner, [args.case], scheduler=args.scheduler)
        made.begin()
        made.files += write_draw(outcomes, runner, caption(args), args.output)
        made.files += _reported(args, outcomes, runner, content(same, made.fits, [], read))
    if not out.silent:
        announce(outcomes)
    for file in (*made.files, record):
        out.say(f"written: {file}")
    out.document({"summaries": [summary.record for summary in summaries(outcomes)], "files": made.files})
    return 0


def _report(args: argparse.Namespace) -> list[Path]:
    return [args.report] if args.report else []


def _reported(
    args: argparse.Namespace, outcomes: Sequence["Outcome"], runner: "CaseRunner", provenance: Any
) -> list[Path]:
    """Writes the report if one is asked for; returns the file."""
    for path in _report(args):
        from ..studies.robustness import robustness_report_html

        robustness_report_html.report(outcomes, runner, provenance, path)
    return _report(args)


def _as_given(args: argparse.Namespace) -> str:
    """The options that make the runs what they are; here our controller alone is not what is usual."""
    ours = PLACES["controller"][0]
    alone = f" --controller {ours}" if args.controller == [ours] else ""
    return f"{alone} {as_given(args)}".rstrip()


def _systems(given: "Given") -> dict[str, Any]:
    """The systems that run, by the names of plant and controller."""
    from ..simulation.simulate import looped

    return {" with ".join(key): looped(*loop) for key, loop in given.items()}


def _distinguishing(runner: "CaseRunner", given: "Given") -> dict[str, Any]:
    from ..studies.robustness.robustness_campaign import distinguishing as of_the_draws

    systems = _systems(given)
    loops = {" with ".join(key): loop for key, (_, loop) in given.items()}
    return of_the_draws(runner) | {name: distinguishing(loops[name], system, None) for name, system in systems.items()}
