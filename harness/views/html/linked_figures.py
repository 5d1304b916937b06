"""Figures that are zoomed and moved together: panels over one axis, with a common crosshair and legends to click on."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from bokeh.models import ColumnDataSource, Range1d
    from bokeh.plotting import figure as Figure

Columns = Mapping[str, np.ndarray]
"""What is drawn, by name; all of the same length."""

HEIGHT = 210
"""Of a panel, in pixels."""


class Curve(NamedTuple):
    """How a column is drawn; the later ones are on top."""

    column: str
    label: str
    color: str
    dash: str = "solid"
    width: float = 1.4


class Panel(NamedTuple):
    """Axes over those that it is linked with.

    Attributes:
        x: column of the abscissa.
        scale: of the ordinate, "linear" or "log".
    """

    label: str
    curves: Sequence[Curve]
    x: str = "time"
    scale: str = "linear"


def as_drawn(columns: Columns) -> dict[str, Any]:
    """The columns in single precision, which is more than a screen shows."""
    return {name: np.asarray(column, dtype=np.float32) for name, column in columns.items()}


def source_of(columns: Columns) -> "ColumnDataSource":
    """The columns as they go into the page."""
    from bokeh.models import ColumnDataSource

    return ColumnDataSource(as_drawn(columns))


def window(start: float, end: float) -> "Range1d":
    """What of the abscissa is shown at first."""
    from bokeh.models import Range1d

    return Range1d(start=start, end=end)


def linked(
    panels: Sequence[Panel], source: "ColumnDataSource", x_range: "Range1d", x_label: str, x_scale: str = "linear"
) -> "list[Figure]":
    """A figure for each panel, one below the other; the columns that are absent are not drawn."""
    from bokeh.models import CrosshairTool, Span

    line = Span(dimension="height", line_color="#888888", line_width=1)
    figures = []
    for panel in panels:
        figure = axes(panel.label, x_range=x_range, x_axis_type=x_scale, y_axis_type=panel.scale)
        drawn = [curve for curve in panel.curves if curve.column in source.column_names]
        renderers = [
            figure.line(
                panel.x,
                curve.column,
                source=source,
                legend_label=curve.label,
                color=curve.color,
                line_dash=curve.dash,
                line_width=curve.width,
            )
            for curve in drawn
        ]
        add_hover(figure, renderers[:1], [(panel.x, f"@{{{panel.x}}}{{0.000}}"), *_values(drawn)])
        figure.add_tools(CrosshairTool(overlay=line, dimensions="height"))
        legend_above(figure)
        figure.xaxis.visible = False
        figures.append(figure)
    figures[-1].xaxis.visible = True
    figures[-1].xaxis.axis_label = x_label
    figures[-1].height += 45
    return figures


def _values(curves: Sequence[Curve]) -> list[tuple[str, str]]:
    return [(curve.label, f"@{{{curve.column}}}{{0.00}}") for curve in curves]


def axes(label: str, height: int = HEIGHT, **how: Any) -> "Figure":
    """An empty figure as wide as the page."""
    from bokeh.plotting import figure

    made = figure(
        height=height,
        sizing_mode="stretch_width",
        tools="box_zoom,xwheel_zoom,pan,undo,reset,save",
        active_drag="box_zoom",
        min_border_left=70,
        window_axis="x",
        **how,
    )
    made.yaxis.axis_label = label
    made.xgrid.grid_line_color = made.ygrid.grid_line_color = "#e4e4e4"
    made.toolbar.logo = None
    for axis in (*made.xaxis, *made.yaxis):
        axis.axis_label_text_font_style = "normal"
    if hasattr(made.y_range, "only_visible"):
        made.y_range.only_visible = True  # type: ignore[attr-defined]
    return made


def add_hover(figure: "Figure", renderers: Sequence[Any], tooltips: Sequence[tuple[str, str]]) -> None:
    """The values under the pointer."""
    from bokeh.models import HoverTool

    figure.add_tools(HoverTool(renderers=list(renderers), tooltips=list(tooltips), mode="vline"))


def legend_above(figure: "Figure") -> None:
    """A legend where it covers no curve; a click on an entry hides its curve."""
    if not figure.legend:
        return
    legend = figure.legend[0]
    figure.center.remove(legend)
    figure.add_layout(legend, "above")
    legend.orientation = "horizontal"
    legend.click_policy = "hide"
    legend.border_line_color = None
    legend.margin = 0
    legend.label_text_font_size = "9pt"


def stacked(figures: "Sequence[Figure]") -> Any:
    """Figures one below the other, with one set of tools."""
    from bokeh.layouts import gridplot

    return gridplot(
        [[figure] for figure in figures],
        merge_tools=True,
        toolbar_options={"logo": None},
        sizing_mode="stretch_width",
    )
