"""What a page of figures costs with each library: `python -m benchmarks.plotting_libraries`.

Eight panels of four curves with 3000 points each, everything in one file, opened in Chromium; the contenders take
turns, and the least of all turns is shown. A library that is not installed is left out.
"""

import argparse
import subprocess
import sys
from collections import defaultdict
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

import numpy as np
from rich.console import Console
from rich.table import Table

from driveline.harness.base.interruption import script
from tests.browser import browser

PANELS, CURVES, POINTS = 8, 4, 3000

READY = {
    "bokeh": "window.Bokeh?.documents[0]?.is_idle",
    "plotly": "document.querySelectorAll('.js-plotly-plot .trace').length > 0",
}


def write(library: str, path: Path) -> None:
    """The page."""
    curves = np.random.default_rng(1).normal(size=(PANELS, CURVES, POINTS)).cumsum(axis=2).astype(np.float32)
    t = np.linspace(0.0, 6.0, POINTS, dtype=np.float32)
    if library == "bokeh":
        from bokeh.embed import file_html
        from bokeh.plotting import figure
        from bokeh.resources import INLINE

        from driveline.harness.views.html.linked_figures import shown, stacked
        from driveline.harness.views.panels import Axis

        x_range, figures = shown(Axis("", (0.0, 6.0))), []
        for panel in curves:
            figures.append(figure(height=210, sizing_mode="stretch_width", x_range=x_range))
            for curve in panel:
                figures[-1].line(t, curve)
        path.write_text(file_html(stacked(figures), INLINE), encoding="utf-8")
    else:
        from plotly.graph_objects import Scatter  # pyright: ignore[reportMissingImports]
        from plotly.subplots import make_subplots  # pyright: ignore[reportMissingImports]

        page = make_subplots(rows=PANELS, cols=1, shared_xaxes=True)
        for k, panel in enumerate(curves, 1):
            for curve in panel:
                page.add_trace(Scatter(x=t, y=curve), row=k, col=1)
        page.update_layout(height=210 * PANELS)
        page.write_html(path, include_plotlyjs=True)


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.plotting_libraries", description=__doc__)
    parser.add_argument("--repetitions", type=int, default=5, help="turns of each (default: %(default)s)")
    parser.add_argument("--write", nargs=2, metavar=("LIBRARY", "FILE"), help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.write:
        write(args.write[0], Path(args.write[1]))
        return
    turns: dict[str, dict[str, list[float]]] = defaultdict(lambda: defaultdict(list))
    with TemporaryDirectory() as folder, browser(Path(folder) / "profile") as opened:
        for _ in range(args.repetitions):
            for library in filter(find_spec, READY):
                page = Path(folder) / f"{library}.html"
                began = perf_counter()
                subprocess.run([sys.executable, "-m", __spec__.name, "--write", library, str(page)], check=True)
                turns[library]["written, s"].append(perf_counter() - began)
                turns[library]["size, MB"].append(page.stat().st_size / 1e6)
                began = perf_counter()
                opened.chrome.get(page.as_uri())
                opened.until(READY[library])
                opened.painted()
                turns[library]["opened, s"].append(perf_counter() - began)
    table = Table("", *next(iter(turns.values())), title="a page of figures")
    for library, costs in turns.items():
        table.add_row(library, *(f"{min(values):.2f}" for values in costs.values()))
    Console().print(table)


if __name__ == "__main__":
    script(main)
