"""A metric of all runs: two dots a line, without and with damping."""

from collections.abc import Sequence
from math import isnan
from typing import Any

from ..colours import BLUE, GREY
from ..metrics_table import SHOWN, Row
from .linked_figures import axes

SHOW = """
source.data = metrics[this.value]
axis.axis_label = this.value
"""


def metric_dots(rows: Sequence[Row]) -> list[Any]:
    """A control for the metric, and its figure.

    Args:
        rows: without and with damping in turn.
    """
    from bokeh.models import ColumnDataSource, CustomJS, HoverTool, Select

    pairs = list(zip(rows[::2], rows[1::2], strict=True))
    names = [f"{on.manoeuvre} on {on.plant}" for _, on in pairs]
    metrics = {}
    for metric, column in SHOWN:
        values = [[column.factor * metric.of(row.metrics) for row in pair] for pair in pairs]
        kept = [(name, *pair) for name, pair in zip(names, values, strict=True) if not any(map(isnan, pair))]
        if kept:
            run, off, on = map(list, zip(*kept, strict=True))
            metrics[f"{column.plain_heading}, {column.unit}"] = {"run": run, "off": off, "on": on}
    if not metrics:
        return []
    first = next(iter(metrics))
    source = ColumnDataSource(dict(metrics[first]))
    figure = axes("", 60 + 20 * len(names), y_range=names[::-1])
    figure.segment("off", "run", "on", "run", source=source, color="#cccccc", line_width=2)
    dots = [
        figure.scatter(end, "run", source=source, color=color, size=9) for end, color in (("off", GREY), ("on", BLUE))
    ]
    tips = [("", "@run"), ("without damping", "@off{0.000}"), ("with", "@on{0.000}")]
    figure.add_tools(HoverTool(renderers=[*dots], tooltips=tips))
    figure.xaxis.axis_label = first
    control = Select(title="Metric", value=first, options=list(metrics), width=420)
    given = {"source": source, "metrics": metrics, "axis": figure.xaxis[0]}
    control.js_on_change("value", CustomJS(args=given, code=SHOW))
    return [control, figure]
