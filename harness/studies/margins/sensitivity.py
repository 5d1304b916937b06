"""How the metrics of a run depend on each parameter, of the car, which the controller does not notice, and its own;
with a figure of those that matter most."""

from collections.abc import Mapping, Sequence
from math import isnan, nan
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from fmublocks.block.declaration import Real, variables

from ....fmus.building.parameter_files import OF_A_RUN
from ...design.loop_parameters import loop_records
from ...metrics.declaration import declared
from ...metrics.run_metrics import Metrics

CHANGE = 0.1
"""By what share of itself each parameter is larger and smaller."""

VARIED_IN = ("tipin15", "launch")

SHOWN = ("overshoot", "gear_torque_rms", "jerk_rms", "response_delay", "withheld_time")
"""The metrics whose dependence is computed."""

OF_THE_NOISE = ("T_s",)
"""Parameters that are none of a car or a controller."""


class Sensitivity(NamedTuple):
    """Of the metrics of a manoeuvre with a plant to a parameter.

    Attributes:
        changes: by metric, (M(1.1 p) - M(0.9 p))/(0.2 M(p)): by how many % the metric changes for 1 % of the parameter.
    """

    plant: str
    manoeuvre: str
    parameter: str
    changes: Mapping[str, float]

    @property
    def largest(self) -> float:
        """In magnitude."""
        return float(np.nanmax(np.abs([*self.changes.values(), 0.0])))


def varied(plant: str, controller: str, values: Mapping[str, Any]) -> dict[str, float]:
    """`instance.parameter` -> value of all that are changed, given the values that are set.

    Numbers that are zero, or that are not 10 % from their bounds, are left out.
    """
    found = {}
    for place, record in loop_records(plant, controller).items():
        for name, declaration, start in variables(record):
            if not isinstance(declaration, Real) or name in OF_A_RUN or name in OF_THE_NOISE:
                continue
            value = float(values.get(f"{place}.{name}", start))
            low, high = sorted(((1.0 - CHANGE) * value, (1.0 + CHANGE) * value))
            if value != 0.0 and declaration.minimum <= low and high <= declaration.maximum:
                found[f"{place}.{name}"] = value
    return found


def sensitivity(plant: str, manoeuvre: str, parameter: str, runs: Sequence[Metrics]) -> Sensitivity:
    """From the metrics of three runs, with the parameter smaller, as it is, and larger."""
    small, nominal, large = runs

    def change(name: str) -> float:
        values = [getattr(metrics, name) for metrics in (small, nominal, large)]
        if any(isnan(value) for value in values) or values[1] == 0.0:
            return nan
        return (values[2] - values[0]) / (2.0 * CHANGE * values[1])

    names = [metric.name for metric in declared(Metrics) if metric.name in SHOWN]
    return Sensitivity(plant, manoeuvre, parameter, {name: change(name) for name in names})


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


def plot_sensitivity(found: Sequence[Sensitivity], title: str, stem: Path) -> list[Path]:
    """Parameters as rows, the metrics of each plant and manoeuvre as columns; returns the files."""
    from ...views.figure_style import in_cell, matrix_axes, sheet  # not for the workers, which draw nothing

    rows = most_important(found)
    panels = list(dict.fromkeys((each.plant, each.manoeuvre) for each in found))
    columns = [metric.column.plain_heading for metric in declared(Metrics) if metric.name in SHOWN and metric.column]
    size = 10.2, 0.21 * len(rows) + 2.6
    with sheet(size, title, stem, pads=(0.04, 0.04)) as (figure, files):
        grid = figure.subplots(1, len(panels), sharey=True, squeeze=False)[0]
        for axes, (plant, manoeuvre) in zip(grid, panels, strict=True):
            here = {each.parameter: each for each in found if (each.plant, each.manoeuvre) == (plant, manoeuvre)}
            nothing = dict.fromkeys(SHOWN, np.nan)
            cells = [[(here[row].changes if row in here else nothing)[name] for name in SHOWN] for row in rows]
            shown = axes.pcolormesh(np.ma.masked_invalid(cells), cmap="RdBu_r", vmin=-SCALE, vmax=SCALE, edgecolors="w")
            for (row, column), value in np.ndenumerate(np.array(cells)):
                if abs(value) >= 0.05:
                    colour = "white" if abs(value) > 0.7 * SCALE else "black"
                    in_cell(axes, column, row, f"{value:.1f}", colour)
            matrix_axes(axes, columns, rows, f"{plant}\n{manoeuvre}")
        figure.colorbar(shown, ax=list(grid), label="change of the metric in % for 1 % of the parameter", shrink=0.7)
    return files
