"""A metric of all runs: two dots a line, without and with damping."""

from collections.abc import Sequence
from math import isnan

import numpy as np

from ..colours import BLUE, GREY
from ..metrics_table import SHOWN, Row
from ..panels import Axis, Curve, Panel, Points
from .figures import Figure


def metric_dots(rows: Sequence[Row]) -> list[Figure]:
    """The dots, with a control for the metric; none if no run has any.

    Args:
        rows: without and with damping in turn.
    """
    pairs = list(zip(rows[::2], rows[1::2], strict=True))
    choices: dict[str, list[Panel]] = {}
    windows: dict[str, tuple[float, float]] = {}
    for metric, column in SHOWN:
        values = {
            f"{on.manoeuvre} on {on.plant}": [column.factor * metric.of(r.metrics) for r in (off, on)]
            for off, on in pairs
        }
        kept = {name: pair for name, pair in values.items() if not any(map(isnan, pair))}
        if kept:
            name = f"{column.plain_heading}, {column.unit}"
            choices[name] = [_panel(kept)]
            low, high = np.min(list(kept.values())), np.max(list(kept.values()))
            windows[name] = min(0.0, 1.05 * low), max(1.05 * high, 1e-6)
    return [Figure(choices, Axis("", (0.0, 1.0)), windows, "Metric")] if choices else []


def _panel(pairs: dict[str, list[float]]) -> Panel:
    """The runs by name, from above to below."""
    count = len(pairs)
    height = np.arange(count, 0.0, -1.0)
    off, on = np.array(list(pairs.values())).T
    lines = [
        Curve(np.sort(pair), np.full(2, y), color="#cccccc", width=1.6)
        for y, pair in zip(height, pairs.values(), strict=True)
    ]
    dots = [Points(off, height, "without damping", GREY, 9.0), Points(on, height, "with damping", BLUE, 9.0)]
    ticks = dict(zip(height.tolist(), pairs, strict=True))
    return Panel("", [*lines, *dots], bounds=(0.4, count + 0.6), ticks=ticks, height=max(0.4, 0.12 * count))
