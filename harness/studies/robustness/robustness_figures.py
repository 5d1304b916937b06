"""Figures of a campaign: how the metrics are distributed, and a draw with and without damping."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ...views.colours import GREY
from ...views.figure_options import FigureOptions
from ...views.figure_style import plot
from ...views.panels import DASHED, SOLID, Axis, Curve, Level, Panel
from ...views.signal_lines import CONTROLLERS, WITHOUT, Runs
from ...views.step_figure import plot_step
from .case_runs import CaseRunner
from .draws import draw
from .outcome import SHOWN, Case
from .summary import Summary

TICKS = {float(share): str(share) for share in (0, 25, 50, 75, 95)}
"""Of the shares in %, with the line that the goals are read at."""

DRAWN = {
    "settling_time": (0.05, 5.0),
    "overshoot": (0.02, 3.0),
    "jerk_rms_to_50_Hz": (2.0, 60.0),
    "response_delay": (0.025, 0.4),
}
"""The metrics of the figure, and from where to where in SI units."""


def distributions(summaries: Sequence[Summary], heading: str = "") -> list[Panel]:
    """Which share of the runs stays below each value of a metric, for each metric with all controllers.

    Args:
        summaries: of a manoeuvre on a plant.
        heading: of the first panel.
    """
    panels = []
    for metric, bounds in DRAWN.items():
        column = SHOWN[metric]
        window = bounds[0] * column.factor, bounds[1] * column.factor
        x = Axis(f"{column.plain_heading} in {column.printed_unit}", window, "log")
        curves = [
            _distribution(summary, metric, window[0], CONTROLLERS[k % len(CONTROLLERS)][0], 0.9 if k else 1.6)
            for k, summary in enumerate(summaries)
        ]
        parts = [*curves, Level(95.0, GREY, DASHED)]
        panels.append(Panel("share of the draws in %", parts, heading, bounds=(0.0, 101.0), ticks=TICKS, x=x))
        heading = ""
    return panels


def _distribution(summary: Summary, metric: str, low: float, color: str, width: float) -> Curve:
    values = np.sort([outcome.magnitude(metric) for outcome in summary.outcomes]) * SHOWN[metric].factor
    shares = 100.0 * np.arange(1, len(values) + 1) / len(values)
    values = np.where(np.isfinite(values), np.maximum(values, low), np.nan)
    return Curve(np.append(low, values), np.append(0.0, shares), summary.controller, color, SOLID, width, held=True)


def plot_distributions(summaries: Sequence[Summary], plant: str, caption: str, stem: Path) -> list[Path]:
    """Draws the distributions of a plant, with a column for each manoeuvre; returns the files."""
    groups: dict[str, list[Summary]] = {}
    for summary in summaries:
        if summary.plant == plant:
            groups.setdefault(summary.manoeuvre, []).append(summary)
    columns = [distributions(group, manoeuvre) for manoeuvre, group in groups.items()]
    rows = list(zip(*columns, strict=True))
    runs = len(next(iter(groups.values()))[0].outcomes)
    title = f"{plant}: share of {runs} draws that stay below a value"
    return plot(rows, Axis("", (0.0, 1.0)), title, stem, FigureOptions(caption), size=(7.2, 1.95), key=4)


def both_runs(runner: CaseRunner, case: Case) -> Runs:
    """A case again, without damping and with it."""
    return {name: runner.results(case, name != WITHOUT) for name in (WITHOUT, case.controller)}


def plot_draw(runner: CaseRunner, case: Case, caption: str, stem: Path) -> list[Path]:
    """Runs a case again, without damping and with it, and draws both; returns the files."""
    runs = both_runs(runner, case)
    drawn = f"draw {draw(case.number, runner.seed)}; {case.controller}"
    options = FigureOptions("\n".join(filter(None, (drawn, caption))))
    return plot_step(runs, runner.manoeuvre(case), case.plant, stem, options)
