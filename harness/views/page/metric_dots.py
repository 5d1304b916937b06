"""A metric of all runs: dots in a line, without damping and with each controller."""

from collections.abc import Mapping, Sequence
from math import isnan

import numpy as np

from ...metrics.run_metrics import Metrics
from ..metrics_table import SHOWN
from ..panels import Axis, Curve, Panel, Points
from ..signal_lines import looks_of
from .figures import Figure


def metric_dots(runs: Mapping[str, Mapping[str, Metrics]]) -> list[Figure]:
    """The dots, with a control for the metric; none if no run has any.

    Args:
        runs: by the names of the manoeuvres the metrics by the names of the controllers, without damping first.
    """
    choices: dict[str, list[Panel]] = {}
    windows: dict[str, tuple[float, float]] = {}
    for metric, column in SHOWN:
        values = {run: [column.factor * metric.of(each) for each in found.values()] for run, found in runs.items()}
        kept = {run: each for run, each in values.items() if not any(map(isnan, each))}
        if kept:
            name = column.titled
            choices[name] = [_panel(kept, list(next(iter(runs.values()))))]
            low, high = np.min(list(kept.values())), np.max(list(kept.values()))
            windows[name] = min(0.0, 1.05 * low), max(1.05 * high, 1e-6)
    return [Figure(choices, Axis("", (0.0, 1.0)), windows, "Metric")] if choices else []


def _panel(values: Mapping[str, Sequence[float]], names: Sequence[str]) -> Panel:
    """The runs by name, from above to below, with a value for each name."""
    count = len(values)
    height = np.arange(count, 0.0, -1.0)
    lines = [
        Curve(np.array([min(each), max(each)]), np.full(2, y), color="#cccccc", width=1.6)
        for y, each in zip(height, values.values(), strict=True)
    ]
    columns = np.array(list(values.values())).T
    dots = [Points(x, height, name, looks_of(names)[name][0], 9.0) for x, name in zip(columns, names, strict=True)]
    ticks = dict(zip(height.tolist(), values, strict=True))
    return Panel("", [*lines, *dots], bounds=(0.4, count + 0.6), ticks=ticks, height=max(0.4, 0.12 * count))
