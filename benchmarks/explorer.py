"""How soon the explorer's curves follow a move: `python -m benchmarks.explorer`.

From the change of a slider in Chromium to the second frame after the new curves have come, with the native builds;
beside it the time of a core that the runs and their metrics take, which the rest of the machine hardly changes.
"""

import argparse
import re
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import process_time

from rich.console import Console
from rich.table import Table

from driveline.harness.base.interruption import script
from driveline.harness.cosimulation.runs import kept_loaded
from driveline.harness.explorer.request import Request
from driveline.harness.explorer.request_runs import RequestRunner
from driveline.harness.loop.places import NATIVE, PLACES, PLANTS
from driveline.harness.loop.settings import Settings
from tests.browser import browser
from tests.harness.explorer.served import DRAWN

OURS = PLACES["controller"][0]

MOVES = {"a gain": ("k_d", 2.0, 0.02), "the car": ("phi_B", 0.1, 0.002)}
"""Slider, where it begins, and how far it goes at a time."""

KINDS = {"k_d": "gains", "phi_B": "car"}

MOVE = """
const [name, start, step, moves, done] = arguments
const control = sliders[name], took = [], drawn = draw
let began = 0
const move = () => {
  began = performance.now()
  control.value = start + step * (took.length + 1)
  control.dispatchEvent(new Event("input"))
}
draw = () => {
  drawn()
  requestAnimationFrame(() => requestAnimationFrame(() => {
    took.push(performance.now() - began)
    if (took.length < moves) setTimeout(move, 100); else done(took)
  }))
}
move()
"""


def computing(plant: str, name: str, start: float, step: float, moves: int) -> float:
    """Median time of a core in ms from what is wanted to the answer."""
    runner, request = RequestRunner({(plant, OURS): Settings(plant=plant, build=NATIVE)}), Request(plant, "tipin15")
    took = []
    with kept_loaded():
        runner.answer(request)
        for k in range(moves):
            began = process_time()
            runner.answer(replace(request, **{KINDS[name]: {name: start + step * k}}))
            took.append(1e3 * (process_time() - began))
    return median(took)


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.explorer", description=__doc__)
    parser.add_argument("--moves", type=int, default=30, help="of each slider (default: %(default)s)")
    moves = parser.parse_args().moves
    table = Table("", "least, ms", "median, ms", "most, ms", "computing, ms", title="from a move to the curves")
    with TemporaryDirectory() as folder, browser(Path(folder) / "profile") as opened:
        opened.chrome.set_script_timeout(120)
        for plant in PLANTS:
            command = ["explore", "--plant", plant, "--port", "0", "--output", folder, "--build", "native"]
            served = subprocess.Popen([sys.executable, "-m", "driveline", *command], stdout=subprocess.PIPE, text=True)
            try:
                assert served.stdout is not None
                found = re.match(r"\S+", served.stdout.readline())
                assert found
                for what, given in MOVES.items():
                    opened.open(found[0], DRAWN)
                    cost = f"{computing(plant, *given, moves):.0f}"
                    took = opened.chrome.execute_async_script(MOVE, *given, moves)
                    table.add_row(f"{plant}, {what}", *(f"{f(took):.0f}" for f in (min, median, max)), cost)
            finally:
                served.send_signal(signal.SIGTERM)
                served.wait()
    Console().print(table)


if __name__ == "__main__":
    script(main)
