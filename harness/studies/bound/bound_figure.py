"""The figure of the bounds: torque reference and gear torque of the controller and of the best that is possible."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib import style
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from ...metrics.evaluate import T_S, at_samples
from ...views.colours import BLACK, BLUE, GREY, VERMILION
from ...views.figure_style import STYLE, save, titled
from .bounds import Bounded

SHOWN = (-0.01, 0.25)
"""From and to when in s after the step."""

PANELS = (("controller.T_ref", "torque reference\nin N·m"), ("plant.T_gear", "gear torque\nin N·m"))


def plot_bounds(found: Sequence[Bounded], controller: str, title: str, stem: Path) -> list[Path]:
    """A column for each manoeuvre; returns the files."""
    with style.context(STYLE):
        figure = Figure(figsize=(2.2 * len(found) + 1.2, 4.6), layout=ConstrainedLayoutEngine(h_pad=0.08))
        grid = figure.subplots(len(PANELS), len(found), sharex=True, squeeze=False)
        for axes, each in zip(grid.T, found, strict=True):
            task, t_0 = each.task, each.task.manoeuvre.t_0
            limits = 1e3 * (task.times[: len(task.lower)] - t_0)
            for limit in (task.lower, task.upper):
                axes[0].step(limits, limit, where="post", color=GREY, lw=0.8, label="limits")
            runs = ((task.results, controller, BLUE), (each.jointly.results, "best possible", VERMILION))
            for panel, (column, _) in zip(axes, PANELS, strict=True):
                for results, name, colour in runs:
                    sampled = at_samples(results, T_S)
                    t = sampled["time"] - t_0
                    shown = (t >= SHOWN[0]) & (t <= SHOWN[1])
                    ms = 1e3 * t[shown]
                    if column == "controller.T_ref":
                        panel.step(ms, sampled[column][shown], where="post", color=colour, label=name)
                    else:
                        panel.plot(ms, sampled[column][shown], color=colour, label=name)
                demand = np.asarray(task.manoeuvre.T_driver(t_0 + ms / 1e3), dtype=float)
                panel.step(ms, demand, where="post", color=BLACK, ls="--", lw=0.8, label="demand")
                panel.set_xlim(1e3 * SHOWN[0], 1e3 * SHOWN[1])
            axes[0].set_title(f"{task.manoeuvre.name}\n{1.0 / each.ratio(each.jointly):.2f} times the optimum")
            axes[-1].set_xlabel("time after the step in ms")
        for panel, (_, label) in zip(grid[:, 0], PANELS, strict=True):
            panel.set_ylabel(label)
        handles = dict(zip(*reversed(grid[0, 0].get_legend_handles_labels()), strict=True))
        figure.legend(
            handles.values(), handles.keys(), loc="outside lower center", ncols=min(len(handles), 2 * len(found))
        )
        titled(figure, title)
        return save(figure, stem)
