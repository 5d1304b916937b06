"""Figure of the calibration: by how much each parameter of the law changes a metric, as a tornado."""

from pathlib import Path

import numpy as np
from matplotlib.ticker import MaxNLocator

from docs.studies.calibration import FACTOR, LAW, Case, changed_law
from docs.studies.calibration_tables import COLUMNS, Found, change, value
from driveline.harness.views.colours import BLUE, VERMILION
from driveline.harness.views.figure_style import sheet
from driveline.harness.views.metrics_table import number

PANELS = (
    ("settling_time", "tipin15"),
    ("overshoot", "tipin15"),
    ("response_delay", "tipout"),
    ("impact_speed", "tipin15r"),
    ("jerk_rms", "launch"),
    ("gear_torque_rms", "creep"),
)
"""Metric and manoeuvre of each panel."""


def plot_calibration(found: Found, plant: str, stem: Path) -> list[Path]:
    """Parameters as rows, a metric of a manoeuvre in each panel; returns the files."""
    rows = np.arange(len(LAW))
    title = f"{plant}: parameters of the damping law, one at a time"
    with sheet((9.6, 6.2), title, stem, pads=(0.1, 0.04)) as (figure, files):
        grid = figure.subplots(2, 3, sharey=True)
        for axes, (metric, manoeuvre) in zip(grid.flat, PANELS, strict=True):
            column = COLUMNS[metric]
            smaller, larger = bars(found, plant, manoeuvre, metric)
            axes.barh(rows - 0.19, smaller, 0.38, color=BLUE, label=f"parameter / {FACTOR:g}")
            axes.barh(rows + 0.19, larger, 0.38, color=VERMILION, label=f"parameter x {FACTOR:g}")
            axes.axvline(0.0, color="0.3", lw=0.8)
            axes.set_yticks(rows, LAW)
            axes.set_ylim(len(LAW) - 0.5, -0.5)
            axes.tick_params(axis="y", length=0)
            axes.xaxis.set_major_locator(MaxNLocator(5))
            axes.set_xlabel(f"change of {column.plain_heading} in {column.unit}")
            nominal = number(value(found, Case(plant, manoeuvre), metric), column)
            axes.set_title(f"{manoeuvre}, from {nominal} {column.unit}")
        handles, labels = grid[0, 0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=2)
    return files


def bars(found: Found, plant: str, manoeuvre: str, metric: str) -> tuple[list[float], list[float]]:
    """By how much a metric changes, in the unit of the tables, with each parameter smaller, and larger."""
    pairs = [
        [COLUMNS[metric].factor * change(found, plant, manoeuvre, metric, given) for given in changed_law(name)]
        for name in LAW
    ]
    smaller, larger = zip(*pairs, strict=True)
    return list(smaller), list(larger)
