"""Figures of a campaign: how the metrics are distributed, and a draw with and without damping."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib import style
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from ...manoeuvres.catalogue import MANOEUVRES as CATALOGUE
from ...views.colours import COLOURS
from ...views.figure_options import FigureOptions
from ...views.figure_style import STYLE, save, titled
from ...views.step_figure import plot_step
from .case_runs import CaseRunner
from .draws import draw
from .outcome import SHOWN, Case
from .summary import Summary

DRAWN = {
    "settling_time": (0.05, 5.0),
    "overshoot": (0.02, 3.0),
    "jerk_rms_to_50_Hz": (2.0, 60.0),
    "response_delay": (0.025, 0.4),
}
"""The metrics of the figure, and from where to where in SI units."""


def plot_distributions(summaries: Sequence[Summary], plant: str, caption: str, stem: Path) -> list[Path]:
    """Draws for a plant which share of the runs stays below each value of a metric; returns the files."""
    its = [summary for summary in summaries if summary.plant == plant]
    manoeuvres = list(dict.fromkeys(summary.manoeuvre for summary in its))
    with style.context(STYLE):
        figure = Figure(figsize=(7.2, 1.9 * len(DRAWN) + 1.0), layout=ConstrainedLayoutEngine(h_pad=0.06))
        grid = figure.subplots(len(DRAWN), len(manoeuvres), sharey=True, squeeze=False)
        runs = len(its[0].outcomes)
        titled(figure, f"{plant}: share of {runs} draws that stay below a value", caption)
        for (metric, bounds), row in zip(DRAWN.items(), grid, strict=True):
            for manoeuvre, axes in zip(manoeuvres, row, strict=True):
                _distribution(axes, [each for each in its if each.manoeuvre == manoeuvre], metric, bounds)
            row[0].set_ylabel("share of the draws in %")
        for manoeuvre, axes in zip(manoeuvres, grid[0], strict=True):
            axes.set_title(manoeuvre)
        lines, labels = grid[0, 0].get_legend_handles_labels()
        figure.legend(lines[::-1], labels[::-1], loc="outside lower center", ncols=4)
        return save(figure, stem)


def _distribution(axes: Axes, summaries: Sequence[Summary], metric: str, bounds: tuple[float, float]) -> None:
    column = SHOWN[metric]
    low, high = (bound * column.factor for bound in bounds)
    for k, summary in reversed(list(enumerate(summaries))):  # the first on top
        values = np.sort([outcome.magnitude(metric) for outcome in summary.outcomes]) * column.factor
        shares = 100.0 * np.arange(1, len(values) + 1) / len(values)
        axes.step(
            np.concatenate(([low], np.clip(values, low, None), values[-1:])),
            np.concatenate(([0.0], shares, shares[-1:])),
            where="post",
            color=COLOURS[k % len(COLOURS)],
            lw=1.6 if k == 0 else 0.9,
            label=summary.controller,
        )
    axes.axhline(95.0, color="0.5", lw=0.6, ls="--")
    axes.set(xscale="log", xlim=(low, high), ylim=(0.0, 101.0), xlabel=f"{column.plain_heading} in {column.unit}")
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 3.0)))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())


def plot_draw(runner: CaseRunner, case: Case, caption: str, stem: Path) -> list[Path]:
    """Runs a case again, without damping and with it, and draws both; returns the files."""
    runs = [runner.results(case, control) for control in (False, True)]
    drawn = f"draw {draw(case.number, runner.seed)}; {case.controller}"
    options = FigureOptions("\n".join(filter(None, (drawn, caption))))
    return plot_step(runs, CATALOGUE[case.manoeuvre], case.plant, stem, options)
