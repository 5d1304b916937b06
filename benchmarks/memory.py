"""How much memory runs take: a long one with its metrics, figure and signals, and many whose answers come one by one.

The most that a process had at a time, as the system counts it (`ru_maxrss`): with the libraries that it shares with
others, and with the pages of files that it has mapped and touched. The command is what users call; of many runs that
of the process that waits and of the largest worker are shown. Each answer is all signals of a run of 0.1 s.
"""

import argparse
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from resource import RUSAGE_CHILDREN, RUSAGE_SELF, getrusage
from tempfile import TemporaryDirectory

from rich.console import Console
from rich.table import Table

from driveline.harness.base.interruption import script
from driveline.harness.cosimulation.results import Results
from driveline.harness.loop.places import NATIVE, PLANTS
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.many_runs import many
from driveline.harness.simulation.simulate import simulate

MB = 1024.0
"""In what ru_maxrss counts."""

BRIEF = replace(MANOEUVRES["tipin15"], duration=0.1)

DRIVE = """\
duration = {}
v_0 = "50 km/h"
T_driver = [{{ kind = "constant", value = 12.0 }}, {{ kind = "sine", amplitude = 40.0, frequency = 0.05 }}]
"""
"""To and fro between both flanks of the gear."""

EXAMPLES = """\
examples:
  python -m benchmarks.memory
  python -m benchmarks.memory --seconds 400 --cases 1000
"""


def long_run(plant: str, seconds: float, options: tuple[str, ...]) -> float:
    """MB of the command that drives for so many seconds, at 1 ms."""
    with TemporaryDirectory() as folder:
        manoeuvre = Path(folder) / "drive.toml"
        manoeuvre.write_text(DRIVE.format(seconds), encoding="utf-8")
        command = (
            "-m",
            "driveline",
            "simulate",
            "--plant",
            plant,
            "--manoeuvre",
            str(manoeuvre),
            "--output",
            folder,
            "--build",
            NATIVE,
        )
        process = os.posix_spawn(sys.executable, [sys.executable, *command, "--quiet", *options], os.environ)
        _, status, used = os.wait4(process, 0)
        if status:
            raise SystemExit(f"driveline {' '.join(command)} failed")
    return used.ru_maxrss / MB


def brief_run(seed: int) -> Results:
    return simulate(BRIEF, PLANTS[-1], build=NATIVE, seed=seed)


def many_runs(cases: int) -> tuple[float, float]:
    """MB of the process that waits for so many runs, and of a worker; once in a process."""
    with many(brief_run, workers=2) as answers:
        for run in answers(range(1, cases + 1)):
            assert len(run)
    return getrusage(RUSAGE_SELF).ru_maxrss / MB, getrusage(RUSAGE_CHILDREN).ru_maxrss / MB


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seconds", type=float, default=3600.0, help="of the long run (default: %(default)s)")
    parser.add_argument("--cases", type=int, default=10_000, help="beside 100 of them (default: %(default)s)")
    parser.add_argument("--only-cases", type=int, help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.only_cases:
        print(*many_runs(args.only_cases))
        return
    table = Table("", "MB", "MB of a worker", title="the most memory at a time")
    for format in ("csv", "parquet"):
        options = "--plot", "--format", format
        table.add_row(f"{args.seconds:g} s, figure, {format}", f"{long_run(PLANTS[-1], args.seconds, options):.0f}", "")
    for cases in (100, args.cases):
        command = [sys.executable, "-m", "benchmarks.memory", "--only-cases", str(cases)]
        found = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout.split()
        table.add_row(f"{cases} runs", *(f"{float(each):.0f}" for each in found))
    Console().print(table)


if __name__ == "__main__":
    script(main)
