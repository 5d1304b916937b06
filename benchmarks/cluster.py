"""What tip-ins with metrics cost on a Dask cluster of this machine.

Efficiency is the processor time of the runs themselves, as their threads count it, over all that the workers use
from the first run to the last: both are of the same moment, whatever else the machine does. Beside it stands what a
run costs in scheduler and waiting process, and the bytes of a batch.
"""

import argparse
from pickle import dumps
from resource import RUSAGE_SELF, getrusage
from time import process_time, thread_time
from typing import Any, cast

from distributed import Client, LocalCluster
from rich.console import Console
from rich.table import Table

from driveline.harness.loop.places import NATIVE, PLANTS
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.metrics.evaluate import evaluate
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.simulation.simulate import simulate
from fmuloop.many_runs import many
from toolground.interruption import script

TIPIN = MANOEUVRES["tipin15"]

EXAMPLES = """\
examples:
  python -m benchmarks.cluster
  python -m benchmarks.cluster --runs 400 --batch 1
"""


def tip_in(seed: int) -> tuple[Metrics, float]:
    """The metrics, and the seconds of processor time."""
    began = thread_time()
    return evaluate(simulate(TIPIN, PLANTS[-1], build=NATIVE, seed=seed), TIPIN), thread_time() - began


def processor_time() -> float:
    used = getrusage(RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def on_workers(count: int, runs: int, batch: int) -> tuple[float, float, float]:
    """Seconds of processor time a run: of the run itself, of its worker, and of what sends and receives it."""
    given: Any = {"n_workers": count, "threads_per_worker": 1, "dashboard_address": None}
    with (
        cast(Any, LocalCluster(**given)) as cluster,
        Client(cluster, set_as_default=False) as client,
        many(tip_in, executor=cast(Any, client).get_executor(), batch=batch) as answers,
    ):
        for _ in answers(range(4 * count * batch)):  # all have loaded their loop
            pass
        before: Any = client.run(processor_time)
        began = process_time()
        alone = sum(seconds for _, seconds in answers(range(runs)))
        here = process_time() - began
        after: Any = client.run(processor_time)
    return alone / runs, (sum(after.values()) - sum(before.values())) / runs, here / runs


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--runs", type=int, default=1000, help="on each cluster (default: %(default)s)")
    parser.add_argument("--batch", type=int, default=16, help="runs of a task (default: %(default)s)")
    args = parser.parse_args()
    table = Table(
        "workers", "ms a run", "with its worker", "efficiency", "scheduler and client", title=f"batches of {args.batch}"
    )
    for count in (1, 2, 4):
        alone, there, here = on_workers(count, args.runs, args.batch)
        table.add_row(
            f"{count}", *(f"{1e3 * each:.2f}" for each in (alone, there)), f"{alone / there:.2f}", f"{1e3 * here:.2f}"
        )
    Console().print(table)
    batch = range(args.batch)
    answers = [(tip_in(seed)[0], list[str]()) for seed in batch]
    print(f"bytes of a batch: cases {len(dumps(list(batch)))}, answers {len(dumps(answers))}")


if __name__ == "__main__":
    script(main)
