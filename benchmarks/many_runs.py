"""What a run costs beside its steps when the loop is loaded already, alone and on all cores.

Both are ratios of times taken side by side, so that other load on the machine counts on both sides: processor time
of further runs of a loaded loop over that of the steps in them; and what many runs of a tip-in with their metrics
take, from the start of the processes to their end, over the steps in them divided by the number of cores.
"""

import argparse
from functools import partial
from statistics import median
from time import perf_counter, process_time
from unittest.mock import patch

import numpy as np
from loky import cpu_count
from rich.console import Console
from rich.table import Table

from benchmarks.timed import Timed
from driveline.harness.base.interruption import script
from driveline.harness.cosimulation.compiled_steps import LIBRARY, CompiledSteps
from driveline.harness.cosimulation.experiment import Experiment
from driveline.harness.cosimulation.loading import loaded
from driveline.harness.cosimulation.steps import Refusal, interpreted
from driveline.harness.loop.places import PLANTS
from driveline.harness.loop.settings import loop
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.metrics.evaluate import evaluate
from driveline.harness.simulation.many_runs import run_many
from driveline.harness.simulation.simulate import signals, simulate, start

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


def tip_in(plant: str, seed: int) -> float:
    """Seconds that the steps take in a run that is evaluated."""
    seconds, make = 0.0, CompiledSteps.__call__

    def timed(steps: CompiledSteps, table: np.ndarray, numbers: range) -> Refusal | None:
        nonlocal seconds
        began = perf_counter()
        refusal = make(steps, table, numbers)
        seconds += perf_counter() - began
        return refusal

    with patch.object(CompiledSteps, "__call__", timed):
        evaluate(simulate(TIPIN, plant, seed=seed), TIPIN)
    return seconds


def many(plant: str, runs: int) -> tuple[float, float]:
    """Seconds of many runs on all cores, and of the steps in them over the number of cores."""
    began = perf_counter()
    steps = run_many(partial(tip_in, plant), range(1, runs + 1))
    return perf_counter() - began, sum(steps) / cpu_count()


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--runs", type=int, default=1000, help="on all cores (default: %(default)s)")
    args = parser.parse_args()
    table = Table("", "plant", "s", "its steps, s", "ratio", title=f"{TIPIN.name}, {cpu_count()} cores")
    for plant in PLANTS:
        whole, alone = further_runs(plant, 50)
        table.add_row("a further run", plant, f"{whole:.4f}", f"{alone:.4f}", f"{whole / alone:.2f}")
    for plant in PLANTS if LIBRARY else ():
        whole, alone = many(plant, args.runs)
        table.add_row(f"{args.runs} runs with metrics", plant, f"{whole:.1f}", f"{alone:.1f}", f"{whole / alone:.2f}")
    Console().print(table)


if __name__ == "__main__":
    script(main)
