"""What tip-ins with metrics cost on a Dask cluster of this machine, beside the same ones in one process.

Processor time is that of the workers, from the first answer of each to its last, so that other load on the machine does
not count; efficiency is that of the runs in one process over it. Beside it stands what a run costs besides: processor
time of scheduler and waiting process, messages and bytes.
"""

import argparse
from pickle import dumps
from resource import RUSAGE_SELF, getrusage
from time import process_time

from distributed import Client, LocalCluster
from rich.console import Console
from rich.table import Table

from driveline.harness.base.interruption import script
from driveline.harness.loop.places import NATIVE, PLANTS
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.metrics.evaluate import evaluate
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.simulation.many_runs import many
from driveline.harness.simulation.simulate import simulate

TIPIN = MANOEUVRES["tipin15"]

EXAMPLES = """\
examples:
  python -m benchmarks.cluster
  python -m benchmarks.cluster --runs 400 --batch 1
"""


def tip_in(seed: int) -> Metrics:
    return evaluate(simulate(TIPIN, PLANTS[-1], build=NATIVE, seed=seed), TIPIN)


def processor_time() -> float:
    used = getrusage(RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def alone(runs: int) -> float:
    """Seconds of processor time of a run in this process, whose loop is loaded."""
    with many(tip_in, workers=1) as answers:
        found = answers(range(runs + 1))
        next(found)
        began = process_time()
        for _ in found:
            pass
    return (process_time() - began) / runs


def on_workers(count: int, runs: int, batch: int) -> tuple[float, float]:
    """Seconds of processor time of a run on so many workers, and of what sends and receives it."""
    with (
        LocalCluster(n_workers=count, threads_per_worker=1, dashboard_address=None) as cluster,
        Client(cluster, set_as_default=False) as client,
        many(tip_in, scheduler=cluster.scheduler_address, batch=batch) as answers,
    ):
        for _ in answers(range(4 * count * batch)):  # all have loaded their loop
            pass
        before, began = client.run(processor_time), process_time()
        for _ in answers(range(runs)):
            pass
        after = client.run(processor_time)
        return (sum(after.values()) - sum(before.values())) / runs, (process_time() - began) / runs


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--runs", type=int, default=1000, help="on each cluster (default: %(default)s)")
    parser.add_argument("--batch", type=int, default=16, help="runs of a task (default: %(default)s)")
    args = parser.parse_args()
    one = alone(args.runs)
    table = Table(
        "workers", "ms a run", "efficiency", "scheduler and client, ms a run", title=f"batches of {args.batch}"
    )
    table.add_row("this process", f"{1e3 * one:.2f}", "", "")
    for count in (1, 2, 4):
        there, here = on_workers(count, args.runs, args.batch)
        table.add_row(f"{count}", f"{1e3 * there:.2f}", f"{one / there:.2f}", f"{1e3 * here:.2f}")
    Console().print(table)
    batch = range(args.batch)
    answers = [(tip_in(seed), list[str]()) for seed in batch]
    print(f"bytes of a batch: cases {len(dumps(list(batch)))}, answers {len(dumps(answers))}")


if __name__ == "__main__":
    script(main)
