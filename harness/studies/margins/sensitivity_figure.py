"""Figure of the sensitivities: the parameters that matter most, against the metrics."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ...metrics.declaration import declared
from ...metrics.run_metrics import Metrics
from ...views.figure_options import FigureOptions
from ...views.figure_style import matrix_axes, sheet
from .sensitivity import SHOWN, Sensitivity

MOST = 24
"""Parameters that are shown."""

SCALE = 1.0
"""Change that has the full colour."""


def most_important(found: Sequence[Sensitivity], most: int = MOST) -> list[str]:
    """The parameters to which some metric is most sensitive, the largest first."""
    largest: dict[str, float] = {}
    for each in found:
        largest[each.parameter] = max(largest.get(each.parameter, 0.0), each.largest)
    return sorted(largest, key=lambda name: -largest[name])[:most]


def plot_sensitivity(found: Sequence[Sensitivity], title: str, stem: Path, caption: str = "") -> list[Path]:
    """Parameters as rows, the metrics of each plant and manoeuvre as columns; returns the files."""
    rows = most_important(found)
    panels = list(dict.fromkeys((each.plant, each.manoeuvre) for each in found))
    columns = [metric.column.plain_heading for metric in declared(Metrics) if metric.name in SHOWN and metric.column]
    size = 10.2, 0.21 * len(rows) + 2.6
    with sheet(size, title, stem, FigureOptions(caption), pads=(0.04, 0.04)) as (figure, files):
        grid = figure.subplots(1, len(panels), sharey=True, squeeze=False)[0]
        for axes, (plant, manoeuvre) in zip(grid, panels, strict=True):
            here = {each.parameter: each for each in found if (each.plant, each.manoeuvre) == (plant, manoeuvre)}
            nothing = dict.fromkeys(SHOWN, np.nan)
            cells = [[(here[row].changes if row in here else nothing)[name] for name in SHOWN] for row in rows]
            shown = axes.pcolormesh(np.ma.masked_invalid(cells), cmap="RdBu_r", vmin=-SCALE, vmax=SCALE, edgecolors="w")
            for (row, column), value in np.ndenumerate(np.array(cells)):
                if abs(value) >= 0.05:
                    colour = "white" if abs(value) > 0.7 * SCALE else "black"
                    axes.text(
                        column + 0.5, row + 0.5, f"{value:.1f}", ha="center", va="center", fontsize=6, color=colour
                    )
            matrix_axes(axes, columns, rows, f"{plant}\n{manoeuvre}")
        figure.colorbar(shown, ax=list(grid), label="change of the metric in % for 1 % of the parameter", shrink=0.7)
    return files
