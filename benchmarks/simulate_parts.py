"""Where the processor time of `driveline simulate` goes: `python -m benchmarks.simulate_parts`, in ms.

The least of several processes counts. All that the command imports is imported first.
"""

import json
import sys
from collections.abc import Callable
from importlib import import_module
from time import process_time
from typing import Any

PACKAGES = {"numpy": ("numpy",), "fmpy": ("fmpy",), "rich": ("rich.console", "rich.table")}

MODULES = (
    "cosimulation.loading",
    "manoeuvres.drivable",
    "metrics.evaluate",
    "simulation.provenance",
    "simulation.simulate",
    "studies.compare.compare",
    "views.signals_file",
    "views.terminal",
    "commands.simulate",
)
"""Of the harness, that the command imports."""

LOADED, RUN, REST = "FMUs loaded", "run", "arguments, checks, record"

CALLS = {
    LOADED: ("simulation.simulate", "run"),
    RUN: ("cosimulation.master", "Loop.run"),
    "CSV": ("views.signals_file", "write_signals"),
    "metrics": ("metrics.evaluate", "evaluate"),
    "table": ("views.terminal", "print_runs"),
}
"""What the command calls; the first of them the second."""


def timed(function: Callable[[], Any]) -> float:
    """Seconds of processor time."""
    began = process_time()
    function()
    return process_time() - began


def parts() -> dict[str, float]:
    """Of this process, in s, which nothing was imported into before."""
    found = {"python": process_time()}
    for name, packages in PACKAGES.items():
        found[name] = timed(lambda packages=packages: [import_module(each) for each in packages])
    harness = "driveline.harness"
    found["own modules"] = timed(lambda: [import_module(f"{harness}.{name}") for name in MODULES])
    from tempfile import TemporaryDirectory

    from driveline.harness.commands.cli import main

    for name, (module, called) in CALLS.items():
        owner = import_module(f"{harness}.{module}")
        *inner, function = called.split(".")
        for each in inner:
            owner = getattr(owner, each)
        setattr(owner, function, _noting(name, getattr(owner, function), found))
    with TemporaryDirectory() as folder:
        whole = timed(lambda: main(["simulate", "--manoeuvre", "tipin15", "--output", folder]))
    found[LOADED] -= found[RUN]
    return found | {REST: whole - sum(found[name] for name in CALLS)}


def _noting(name: str, function: Callable[..., Any], found: dict[str, float]) -> Callable[..., Any]:
    def noting(*given: Any, **named: Any) -> Any:
        began = process_time()
        result = function(*given, **named)
        found[name] = process_time() - began
        return result

    return noting


def measure(repetitions: int) -> dict[str, float]:
    """The least time of each part in s."""
    import subprocess  # not in the processes that are measured

    command = [sys.executable, "-m", "benchmarks.simulate_parts", "--once"]
    turns = [
        json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stderr.splitlines()[-1])
        for _ in range(repetitions)
    ]
    return {name: min(turn[name] for turn in turns) for name in turns[0]}


if __name__ == "__main__":
    if sys.argv[1:] == ["--once"]:
        print(json.dumps(parts()), file=sys.stderr)
    else:
        print(*(f"{1e3 * seconds:6.1f}  {name}" for name, seconds in measure(7).items()), sep="\n")
