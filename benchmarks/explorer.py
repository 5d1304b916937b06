"""How soon the curves of the explorer's page follow a move: `python -m benchmarks.explorer`.

From the change of a slider in Chromium to the end of the frame with the new curves. What a worker computes
for it, a run and its metrics, is measured beside it, in time of the clock.
"""

import argparse
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any

from rich.console import Console
from rich.table import Table

from driveline.harness.explorer.content import content, write_page
from driveline.harness.explorer.module import built_as_sources
from driveline.harness.loop.places import PLANTS
from tests.browser import browser
from toolground.interruption import script

MOVES = {"a gain": ("k_d", 2.0, 0.02), "the car": ("phi_B", 0.1, 0.002)}
"""Slider, where it begins, and how far it goes at a time."""

MOVE = """
const [name, start, step, moves, done] = arguments
const control = get(`knob ${name}`), took = [], computed = [], drawn = draw
let began = 0
const move = () => {
  began = performance.now()
  control.value = start + step * (took.length + 1)
  control.dispatchEvent(new Event("input"))
}
draw = (window) => {
  computed.push(performance.now() - began)
  drawn(window)
  requestAnimationFrame(() => setTimeout(() => {
    took.push(performance.now() - began)
    if (took.length < moves) setTimeout(move, 100); else done([took, computed])
  }))
}
move()
"""


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.explorer", description=__doc__)
    parser.add_argument("--moves", type=int, default=30, help="of each slider (default: %(default)s)")
    moves = parser.parse_args().moves
    table = Table("", "least, ms", "median, ms", "most, ms", "least computing, ms", title="from a move to the curves")
    with TemporaryDirectory() as folder, browser(Path(folder) / "profile") as opened:
        page = Path(folder) / "page.html"
        with built_as_sources() as given:
            write_page(content(given), page)
        opened.chrome.set_script_timeout(120)
        for plant in PLANTS:
            for what, given_move in MOVES.items():
                opened.open("about:blank", "true")
                opened.open(f"{page.as_uri()}#plant={plant}")
                took, computed = _moved(opened.chrome, *given_move, moves)
                table.add_row(
                    f"{plant}, {what}", *(f"{f(took):.0f}" for f in (min, median, max)), f"{min(computed):.0f}"
                )
    Console().print(table)


def _moved(chrome: Any, *arguments: Any) -> tuple[list[float], list[float]]:
    took, computed = chrome.execute_async_script(MOVE, *arguments)
    return took, computed


if __name__ == "__main__":
    script(main)
