"""What commands take: `python -m benchmarks.commands`, as ratios of processor times to the start of numpy and scipy.

The contenders take turns in processes of their own; the least of all turns is shown. What they start counts too.
"""

import argparse
import os
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterable
from tempfile import TemporaryDirectory

from rich.console import Console
from rich.table import Table

from toolground.interruption import script

UNIT = "python, import numpy, scipy"

BRIEF: dict[str, tuple[str, ...]] = {
    "python": ("-c", "pass"),
    UNIT: ("-c", "import numpy, scipy"),
    "python, import numpy, scipy.signal": ("-c", "import numpy, scipy.signal"),
    "python, import fmpy": ("-c", "import fmpy"),
    "driveline --help": ("-m", "driveline", "--help"),
    "driveline simulate --help": ("-m", "driveline", "simulate", "--help"),
    "driveline simulate, an unknown manoeuvre": ("-m", "driveline", "simulate", "--manoeuvre", "tipn15"),
    "driveline simulate, up to an unknown parameter": ("-m", "driveline", "simulate", "--set", "plant.nothing=1"),
    "driveline simulate, a manoeuvre of 6 s": ("-m", "driveline", "simulate", "--manoeuvre", "tipin15"),
}

LONG: dict[str, tuple[str, ...]] = {
    "driveline build": ("-m", "driveline", "build", "--output", "fmus"),
    "driveline compare": ("-m", "driveline", "compare"),
    "driveline analyse": ("-m", "driveline", "analyse"),
    "driveline faults, 200 cases": ("-m", "driveline", "faults", "--cases", "200"),
    "driveline robustness, 60 draws": ("-m", "driveline", "robustness", "--cases", "60"),
}
"""A turn of these is enough."""


def seconds(arguments: tuple[str, ...]) -> float:
    """Processor time that Python takes with these arguments, in a folder of its own, and all that it has started.

    Compiled modules are kept and output comes as Python gives it, as with users.
    """
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    with TemporaryDirectory() as folder, open(os.devnull, "wb") as nothing:
        command = [sys.executable, *arguments]
        process = subprocess.Popen(command, cwd=folder, env=environment, stdout=nothing, stderr=nothing)
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    return used.ru_utime + used.ru_stime


def measure(repetitions: int, names: Iterable[str] = (*BRIEF, *LONG)) -> dict[str, float]:
    """The least processor time of each contender in s."""
    turns = defaultdict[str, list[float]](list)
    for turn in range(repetitions):
        for name in names:
            if turn == 0 or name in BRIEF:
                turns[name].append(seconds({**BRIEF, **LONG}[name]))
    return {name: min(times) for name, times in turns.items()}


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.commands", description=__doc__)
    parser.add_argument("--repetitions", type=int, default=15, help="turns of each (default: %(default)s)")
    parser.add_argument("--brief", action="store_true", help="without the commands that take seconds")
    args = parser.parse_args()
    table = Table("", "CPU s", "ratio", title="commands")
    least = measure(args.repetitions, BRIEF if args.brief else (*BRIEF, *LONG))
    for name, time in least.items():
        table.add_row(name, f"{time:.2f}", f"{time / least[UNIT]:.2f}")
    Console().print(table)


if __name__ == "__main__":
    script(main)
