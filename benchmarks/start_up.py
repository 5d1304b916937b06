"""What `driveline` takes before it does anything: `python -m benchmarks.start_up`, as ratios to `import numpy`.

The contenders take turns in processes of their own; the least of all turns is shown.
"""

import argparse
import os
import subprocess
import sys
from collections import defaultdict
from tempfile import TemporaryDirectory
from time import perf_counter

from rich.console import Console
from rich.table import Table

from driveline.harness.base.interruption import script

CONTENDERS: dict[str, tuple[str, ...]] = {
    "python": ("-c", "pass"),
    "python, import numpy": ("-c", "import numpy"),
    "python, import numpy, scipy": ("-c", "import numpy, scipy"),
    "python, import numpy, scipy.signal": ("-c", "import numpy, scipy.signal"),
    "python, import fmpy": ("-c", "import fmpy"),
    "driveline --help": ("-m", "driveline", "--help"),
    "driveline simulate --help": ("-m", "driveline", "simulate", "--help"),
    "driveline simulate, an unknown manoeuvre": ("-m", "driveline", "simulate", "--manoeuvre", "tipn15"),
    "driveline simulate, up to an unknown parameter": ("-m", "driveline", "simulate", "--set", "plant.nothing=1"),
    "driveline simulate, a manoeuvre of 6 s": ("-m", "driveline", "simulate", "--manoeuvre", "tipin15"),
}


def environment() -> dict[str, str]:
    """What users have: compiled modules are kept, and output comes as Python gives it."""
    return {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}


def seconds(arguments: tuple[str, ...], folder: str) -> float:
    """Time that Python takes with these arguments, in a folder."""
    began = perf_counter()
    subprocess.run([sys.executable, *arguments], cwd=folder, env=environment(), capture_output=True, check=False)
    return perf_counter() - began


def measure(repetitions: int) -> dict[str, float]:
    """The least time of each contender in s."""
    turns = defaultdict(list)
    with TemporaryDirectory() as folder:
        for _ in range(repetitions):
            for name, arguments in CONTENDERS.items():
                turns[name].append(seconds(arguments, folder))
    return {name: min(times) for name, times in turns.items()}


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.start_up", description=__doc__)
    parser.add_argument("--repetitions", type=int, default=15, help="turns of each (default: %(default)s)")
    least = measure(parser.parse_args().repetitions)
    table = Table("", "ms", "over import numpy", title="start-up")
    for name, time in least.items():
        table.add_row(name, f"{1e3 * time:.0f}", f"{time / least['python, import numpy']:.2f}")
    Console().print(table)


if __name__ == "__main__":
    script(main)
