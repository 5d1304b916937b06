"""Panels on a page: zoomed and moved together, with a common crosshair and legends to click on."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..panels import Arrow, Axis, Band, Bars, Curve, Dashes, Level, Panel, Part, Points, Spans

if TYPE_CHECKING:
    from bokeh.models import ColumnDataSource, Range1d
    from bokeh.plotting import figure as Figure

Columns = Mapping[str, np.ndarray]
"""What is drawn, by name; all of the same length."""

HEIGHT = 210
"""Of a panel, in pixels."""

LONGEST = 32
"""Characters of a label that are as long as a panel is high."""

PIXELS = 1.4
"""Of a point of the panels' widths and sizes."""


def as_drawn(columns: Columns) -> dict[str, Any]:
    """The columns in single precision, which is more than a screen shows."""
    return {name: np.asarray(column, dtype=np.float32) for name, column in columns.items()}


def source_of(columns: Columns) -> "ColumnDataSource":
    """The columns as they go into the page."""
    from bokeh.models import ColumnDataSource

    return ColumnDataSource(as_drawn(columns))


def shown(x: Axis) -> "Range1d":
    """What of the abscissa is shown at first."""
    from bokeh.models import Range1d

    return Range1d(start=x.window[0], end=x.window[1])


def tables(panels: Sequence[Panel]) -> list[Columns]:
    """What is drawn: a table for all that has the same abscissas, in the order in which the panels have them.

    Panels with the same parts have tables with the same columns, so one's data can take the place of another's.
    """
    found: dict[bytes, dict[str, np.ndarray]] = {}
    for panel in panels:
        for part in panel.parts:
            if not isinstance(part, Level | Arrow):
                table = found.setdefault(part.x.tobytes(), {"x": part.x})
                table |= {f"{name} {len(table)}": getattr(part, name) for name in part.ARRAYS[1:]}
    return list(found.values())


def linked(
    panels: Sequence[Panel],
    x: Axis,
    x_range: "Range1d | None" = None,
    sources: "Sequence[ColumnDataSource] | None" = None,
) -> "list[Figure]":
    """A figure for each panel, one below the other.

    Args:
        x: the abscissa of the panels that have none of their own.
        x_range: of `x`, if others share it.
        sources: with the columns of `tables`, if something changes them.
    """
    from bokeh.models import CrosshairTool, Span

    x_range = x_range or shown(x)
    sources = sources or [source_of(table) for table in tables(panels)]
    names = {source: iter(list(map(str, source.data))[1:]) for source in sources}
    parts = [part for panel in panels for part in panel.parts if not isinstance(part, Level | Arrow)]
    source_by_x = dict(zip(dict.fromkeys(part.x.tobytes() for part in parts), sources, strict=True))
    line = Span(dimension="height", line_color="#888888", line_width=1)
    figures = []
    for panel, below in zip(panels, [*panels[1:], None], strict=True):
        own = panel.x or x
        figure = axes(
            panel.label if len(panel.label) > LONGEST else panel.label.replace("\n", " "),
            round(HEIGHT * panel.height),
            x_range=shown(own) if panel.x else x_range,
            x_axis_type=own.scale,
            y_axis_type=panel.scale,
        )
        values: dict[ColumnDataSource, list[tuple[Any, str, str]]] = {}
        for part in panel.parts:
            if isinstance(part, Level | Arrow):
                _mark(figure, part)
                continue
            source = source_by_x[part.x.tobytes()]
            its = [next(names[source]) for _ in part.ARRAYS[1:]]
            glyph = _add(figure, part, source, its)
            if isinstance(part, Curve):
                values.setdefault(source, []).append((glyph, part.label, f"@{{{its[0]}}}{{0.00}}"))
        for curves in values.values():
            add_hover(figure, [curves[0][0]], [(own.label, "@x{0.000}"), *(curve[1:] for curve in curves)])
        _ticks(figure, panel, own)
        figure.add_tools(CrosshairTool(overlay=line, dimensions="height"))
        legend_above(figure)
        figure.xaxis.visible = below is None or (below.x or x) != own
        if figure.xaxis.visible:
            figure.xaxis.axis_label = own.label
            figure.height = (figure.height or 0) + 45
        figures.append(figure)
    return figures


def _add(figure: "Figure", part: Part, source: "ColumnDataSource", names: Sequence[str]) -> Any:
    """A part, whose arrays have these names in the source, the abscissas aside."""
    how: dict[str, Any] = {"source": source, "color": getattr(part, "color", None)}
    if label := getattr(part, "label", ""):
        how["legend_label"] = label
    match part:
        case Curve(dashes=dashes, width=width):
            how |= {"line_dash": _dash(dashes), "line_width": PIXELS * width}
            return figure.step("x", names[0], mode="after", **how) if part.held else figure.line("x", names[0], **how)
        case Points(size=size, marker=marker):
            marker = {"right": "triangle"}.get(marker, marker)
            return figure.scatter("x", names[0], size=PIXELS * size, marker=marker, **how)
        case Band(alpha=alpha):
            return figure.varea("x", names[0], names[1], fill_alpha=alpha, **how)
        case Bars(breadth=breadth, alpha=alpha):
            return figure.vbar("x", breadth, names[0], alpha=alpha, **how)
        case Spans(alpha=alpha, outlined=outlined):
            look = {"fill_alpha": 0.0, "line_dash": "dashed"} if outlined else {"fill_alpha": alpha, "line_width": 0}
            return figure.vstrip("x", names[0], level="underlay", **how, **look)
    raise TypeError(part)


def _mark(figure: "Figure", part: Level | Arrow) -> None:
    """What is no curve, band or points and remains as it is."""
    from bokeh.models import Span

    if isinstance(part, Arrow):
        figure.segment([part.x], [part.low], [part.x], [part.high], color="black")
        return
    dimension = "height" if part.upright else "width"
    figure.add_layout(Span(location=part.at, dimension=dimension, line_color=part.color, line_dash=_dash(part.dashes)))


def _dash(dashes: Dashes) -> list[int]:
    """In pixels; thin lines too are seen to have gaps."""
    return [round(2.0 * length) for length in dashes]


def _ticks(figure: "Figure", panel: Panel, x: Axis) -> None:
    """What the axes and the line above show, if it is not the usual."""
    from bokeh.models import BasicTickFormatter, LogTicker

    if x.scale == "log":
        figure.xaxis.ticker = LogTicker(mantissas=[1, 3])
        figure.xaxis.formatter = BasicTickFormatter(use_scientific=False)
    for end, bound in zip(("start", "end"), panel.bounds, strict=True):
        if bound is not None:
            setattr(figure.y_range, end, bound)
    if panel.ticks:
        figure.yaxis.ticker = list(panel.ticks)
        figure.yaxis.major_label_overrides = {**panel.ticks}
    if panel.heading or panel.note:
        figure.title = ", ".join(filter(None, (panel.heading, panel.note)))


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
        axis.axis_label_text_font_size = "9pt"
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
