"""What a run costs beside its steps when the loop is loaded already, alone and on all cores.

These are ratios of processor times, which other load on the machine changes little: of further runs of a loaded loop
over the steps in them; and of many runs of a tip-in with their metrics on all cores, in lanes and one by one, with the
start of the processes, over the steps of as many single runs.
"""

import argparse
import resource
from collections.abc import Sequence
from contextlib import nullcontext
from functools import partial
from statistics import median
from time import perf_counter, process_time

from benchmarks.timed import Timed
from driveline.harness.loop.places import PLANTS
from driveline.harness.loop.settings import loop
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.metrics.evaluate import evaluate
from driveline.harness.simulation.simulate import planned, signals, start
from fmuloop import many_runs
from fmuloop.campaign import RunRequest
from fmuloop.compiled_steps import LIBRARY, CompiledSteps
from fmuloop.experiment import Experiment
from fmuloop.loading import loaded
from fmuloop.results import Results
from fmuloop.steps import interpreted
from toolground.interruption import script

TIPIN = MANOEUVRES["tipin15"]

EXAMPLES = """\
examples:
  python -m benchmarks.many_runs
  python -m benchmarks.many_runs --runs 200
"""


def further_runs(plant: str, count: int) -> tuple[float, float]:
    """Seconds of processor time of a run of a loaded loop that is not its first, and of the steps in it: medians."""
    steps = Timed(CompiledSteps if LIBRARY else interpreted)
    whole, alone = [], []
    with loaded(loop(plant), make_steps=steps) as running:
        for _ in range(count + 1):
            before, began = steps.seconds, process_time()
            running.run(Experiment(TIPIN.duration, inputs=signals(TIPIN), parameters=start(TIPIN)))
            whole.append(process_time() - began)
            alone.append(steps.seconds - before)
    return median(whole[1:]), median(alone[1:])


def needed(plant: str, seed: int) -> list[RunRequest]:
    """A run."""
    return [planned(TIPIN, plant, seed=seed)]


def tip_in(_seed: int, runs: Sequence[Results]) -> None:
    """It is evaluated."""
    evaluate(runs[0], TIPIN)


def many(plant: str, runs: int, in_lanes: bool = True) -> tuple[float, float]:
    """Seconds of the clock and of the processor for many runs on all cores, with the start of the processes."""
    from unittest.mock import patch  # not in the processes that run it

    began, before = perf_counter(), _processor_time()
    with nullcontext() if in_lanes else patch.object(many_runs, "lanes_here", lambda: 0):
        many_runs.run_many(tip_in, range(1, runs + 1), runs=partial(needed, plant))
    return perf_counter() - began, _processor_time() - before


def _processor_time() -> float:
    """Of this process and those that it has ended, in s."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(each.ru_utime + each.ru_stime for each in used)


def main() -> None:
    from rich.console import Console
    from rich.table import Table

    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--runs", type=int, default=1000, help="on all cores (default: %(default)s)")
    args = parser.parse_args()
    table = Table("", "plant", "s", "its steps, s", "ratio", title=f"{TIPIN.name}, {many_runs.cores()} cores")
    for plant in PLANTS:
        whole, alone = further_runs(plant, 50)
        table.add_row("a further run", plant, f"{whole:.4f}", f"{alone:.4f}", f"{whole / alone:.2f}")
        steps = args.runs * alone
        for how in ("in lanes", "one by one"):
            _, whole = many(plant, args.runs, how == "in lanes")
            what = f"{args.runs} runs with metrics, {how}"
            table.add_row(what, plant, f"{whole:.1f}", f"{steps:.1f}", f"{whole / steps:.2f}")
    Console().print(table)


if __name__ == "__main__":
    script(main)
