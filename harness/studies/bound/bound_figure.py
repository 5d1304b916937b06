"""The figure of the bounds: torque reference and gear torque of the controller and of the best that is possible."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ...loop.places import T_S
from ...metrics.evaluate import at_samples
from ...views.colours import BLACK, BLUE, GREY, VERMILION
from ...views.figure_style import plot
from ...views.panels import DASHED, Axis, Curve, Panel
from .bounds import Bounded

AFTER = Axis("time after the step in ms", (-10.0, 250.0))


def plot_bounds(found: Sequence[Bounded], controller: str, title: str, stem: Path) -> list[Path]:
    """A column for each manoeuvre; returns the files."""
    rows = list(zip(*(_panels(each, controller) for each in found), strict=True))
    size = 2.2 * len(found) + 1.2, 1.9
    return plot(rows, AFTER, title, stem, size=size, key=min(5, 2 * len(found)), same_y=False)


def _panels(found: Bounded, controller: str) -> list[Panel]:
    task, t_0 = found.task, found.task.manoeuvre.t_0
    runs = ((task.results, controller, BLUE), (found.jointly.results, "best possible", VERMILION))
    t = at_samples(task.results, T_S)["time"]
    demand = Curve(1e3 * (t - t_0), np.asarray(task.manoeuvre.T_driver(t), float), "demand", BLACK, DASHED, 0.8, True)
    limited = 1e3 * (task.times[: len(task.lower)] - t_0)
    limits = [Curve(limited, limit, "limits", GREY, width=0.8, held=True) for limit in (task.lower, task.upper)]

    def curves(column: str, held: bool) -> list[Curve]:
        sampled = ((at_samples(results, T_S), name, color) for results, name, color in runs)
        return [Curve(1e3 * (of["time"] - t_0), of[column], name, color, held=held) for of, name, color in sampled]

    heading = f"{task.manoeuvre.name}\n{1.0 / found.ratio(found.jointly):.2f} times the optimum"
    return [
        Panel("torque reference\nin N·m", [*limits, *curves("controller.T_ref", True), demand], heading),
        Panel("gear torque\nin N·m", [*curves("plant.T_gear", False), demand]),
    ]
