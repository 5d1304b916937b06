"""What a run costs beside its steps when the loop is loaded already, alone and on all cores.

Both are ratios of times taken side by side: a run of a loaded loop, each between two others, over the steps in
it; and many runs of tip-in with their metrics, over the steps of as many runs divided by the number of cores.
The steps alone are timed in this process before and after the many.
"""

import argparse
from functools import partial
from statistics import median
from time import perf_counter

from loky import cpu_count
from rich.console import Console
from rich.table import Table

from harness.cosimulation.compiled import LIBRARY, CompiledSteps
from harness.cosimulation.master import loaded
from harness.cosimulation.steps import interpreted
from harness.cosimulation.system import PLANTS, loop
from harness.manoeuvres.catalogue import MANOEUVRES
from harness.many import run_many
from harness.metrics.evaluate import evaluate
from harness.simulate import signals, simulate, start

from .timed import Timed

TIPIN = MANOEUVRES["tipin15"]

EXAMPLES = """\
examples:
  python -m benchmarks.many_runs
  python -m benchmarks.many_runs --runs 200
"""


def further_runs(plant: str, count: int) -> tuple[list[float], list[float]]:
    """Seconds of each run of a loaded loop but the first, and of the steps in it."""
    steps = Timed(CompiledSteps if LIBRARY else interpreted, perf_counter)
    whole, alone = [], []
    with loaded(loop(plant), make_steps=steps) as running:
        for _ in range(count + 1):
            before, began = steps.seconds, perf_counter()
            running.run(TIPIN.duration, inputs=signals(TIPIN), parameters=start(TIPIN))
            whole.append(perf_counter() - began)
            alone.append(steps.seconds - before)
    return whole[1:], alone[1:]


def tip_in(plant: str, seed: int) -> float:
    """Settling time in s."""
    return evaluate(simulate(TIPIN, plant, seed=seed), TIPIN).settling_time


def many(plant: str, runs: int) -> tuple[float, float]:
    """Seconds of many runs on all cores, and of the steps of as many runs alone over the number of cores."""
    alone = further_runs(plant, 20)[1]
    began = perf_counter()
    run_many(partial(tip_in, plant), range(1, runs + 1))
    took = perf_counter() - began
    alone += further_runs(plant, 20)[1]
    return took, median(alone) * runs / cpu_count()


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--runs", type=int, default=1000, help="on all cores (default: %(default)s)")
    args = parser.parse_args()
    table = Table("", "plant", "s", "steps alone, s", "ratio", title=f"{TIPIN.name}, {cpu_count()} cores")
    for plant in PLANTS:
        whole, alone = map(median, further_runs(plant, 50))
        table.add_row("a further run", plant, f"{whole:.4f}", f"{alone:.4f}", f"{whole / alone:.2f}")
    for plant in PLANTS:
        whole, alone = many(plant, args.runs)
        table.add_row(f"{args.runs} runs with metrics", plant, f"{whole:.1f}", f"{alone:.1f}", f"{whole / alone:.2f}")
    Console().print(table)


if __name__ == "__main__":
    main()
