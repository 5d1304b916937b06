"""How all figures look, how panels are drawn and how they are written; the same results give the same bytes."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from textwrap import fill
from typing import Any

import numpy as np
from matplotlib import style
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter

from toolground.atomic_files import complete

from .figure_options import PLAIN, USUAL_KINDS, FigureOptions
from .panels import MARKERS, Arrow, Axis, Band, Bars, Curve, Dashes, Drawing, Level, Panel, Part, Points, Spans, within

STYLE = {
    "font.size": 9.0,
    "axes.titlesize": 9.0,
    "axes.labelsize": 9.0,
    "legend.fontsize": 8.5,
    "legend.frameon": False,
    "axes.grid": True,
    "grid.color": "0.88",
    "grid.linewidth": 0.5,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "lines.linewidth": 1.0,
    "mathtext.fontset": "dejavuserif",
    "pdf.fonttype": 42,  # TrueType; publishers refuse Type 3
    "svg.fonttype": "path",  # fonts cannot be embedded, and not every machine has those of matplotlib
    "svg.hashsalt": "driveline-damping",  # else names within the file are random
}

METADATA = {
    "png": {"Software": None},
    "pdf": {"CreationDate": None, "Producer": None, "Creator": None},
    "svg": {"Date": None, "Creator": None},
}
"""What matplotlib would say of date and origin, by the kind of file: nothing."""

DPI = 200

CAPTION_SIZE = 7.5
"""In points."""

CHARACTER = 0.6
"""Width of a character of a title over its size; on average it is less."""


NOTE_SIZE = 7.5
"""In points."""

NOTE_LINE = 0.12
"""Of the height of axes, for a line of a note."""

MANY = 30_000
"""Values of a part from which on it is a picture within files for print."""


@contextmanager
def sheet(
    size: tuple[float, float],
    title: str,
    stem: Path,
    options: FigureOptions = PLAIN,
    pads: tuple[float, float] = (0.11, 0.04),
    title_size: float = 10.0,
) -> Iterator[tuple[Figure, list[Path]]]:
    """A figure to be drawn into, with its title and caption, and the files that it is written to at the end.

    Args:
        size: width and height in inches.
        stem: path of the files without their ending.
        pads: between axes in inches, below each other and beside each other.
        title_size: in points.
    """
    files: list[Path] = []
    with style.context(STYLE):
        layout = ConstrainedLayoutEngine(h_pad=pads[0], w_pad=pads[1])
        figure = Figure(figsize=size, dpi=DPI, layout=layout) if options.kinds else _on_screen(size, layout)
        yield figure, files
        figure.align_ylabels()
        titled(figure, title, options.caption, title_size)
        if options.kinds:
            files += save(figure, stem, options.kinds)
        else:
            _show()


def _on_screen(size: tuple[float, float], layout: ConstrainedLayoutEngine) -> Figure:
    """A figure that a window or a notebook shows."""
    from matplotlib import pyplot  # files are written without what windows need

    return pyplot.figure(figsize=size, layout=layout)


def _show() -> None:
    from matplotlib import pyplot

    pyplot.show()


def plot(
    rows: Sequence[Sequence[Panel]],
    x: Axis,
    title: str,
    stem: Path,
    options: FigureOptions = PLAIN,
    *,
    size: tuple[float, float] = (7.2, 1.5),
    key: int = 0,
    same_y: bool = True,
    title_size: float = 10.0,
) -> list[Path]:
    """Draws panels and writes the figure.

    Args:
        rows: of panels beside each other; one that is alone is as wide as all others together.
        x: the abscissa of the panels that have none of their own.
        stem: path of the files without their ending.
        size: width in inches, and height of a row.
        key: columns of one legend below for all panels; 0: one above each row, where it covers no curve, unless the row
            above has the same.
        same_y: the panels of a row share the ordinate.
        title_size: in points.

    Returns:
        The files written.
    """
    heights, columns = [row[0].height for row in rows], max(map(len, rows))
    inches = size[0], size[1] * sum(heights) + 0.8
    below_axes = options._replace(caption="") if key else options
    with sheet(inches, title, stem, below_axes, title_size=title_size) as (figure, files):
        grid = figure.add_gridspec(len(rows), columns, height_ratios=heights)
        above: list[str] = []
        for k, row in enumerate(rows):
            below = rows[k + 1] if k + 1 < len(rows) else ()
            drawn: list[Axes] = []
            for j, panel in enumerate(row):
                shared = drawn[0] if drawn and same_y else None
                axes = figure.add_subplot(grid[k, j] if len(row) > 1 else grid[k, :], sharey=shared)
                drawn.append(axes)
                _draw(axes, panel, x)
                if shared:
                    axes.tick_params(labelleft=False)
                    axes.set_ylabel("")
                if len(row) > 1 and (panel.x or x).scale == "linear":
                    # the label at the end of an axis would touch the first one of its neighbour
                    axes.xaxis.set_major_locator(MaxNLocator(5, prune="upper" if panel is not row[-1] else None))
                if len(below) == len(row) and (below[j].x or x) == (panel.x or x):
                    axes.tick_params(labelbottom=False)
                else:
                    axes.set_xlabel((panel.x or x).label)
            _note(drawn, row, same_y)
            entries = drawn[0].get_legend_handles_labels()[1]
            if entries and entries != above and not key:
                legend(drawn[0], row[0].columns)
            above = entries
            for axes, panel in zip(drawn, row, strict=True):
                axes.set_title(panel.heading, pad=20 if drawn[0].get_legend() else None)
        if key:
            named = dict(zip(*figure.axes[0].get_legend_handles_labels()[::-1], strict=True))
            made = figure.legend(named.values(), named.keys(), loc="outside lower center", ncols=key)
            made.set_title(
                _lines(figure, options.caption, CAPTION_SIZE), FontProperties(size=CAPTION_SIZE)
            )  # as both are below
    return files


def draw(drawing: Drawing, stem: Path, options: FigureOptions = PLAIN) -> list[Path]:
    """Writes a figure that is data; returns the files."""
    rows, x, title, size, key, same_y = drawing
    return plot(rows, x, title, stem, options, size=size, key=key, same_y=same_y)


def _draw(axes: Axes, panel: Panel, x: Axis) -> None:
    """A panel, less what is outside of its window, which the ordinate would show otherwise."""
    x = panel.x or x
    axes.set(xscale=x.scale, yscale=panel.scale, ylabel=panel.label)
    for part in within([panel], *x.window)[0].parts if None in panel.bounds else panel.parts:
        _add(axes, part)
    axes.set_xlim(*x.window)
    if x.scale == "log":
        axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 3.0)))
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axes.xaxis.set_minor_formatter(NullFormatter())
    if panel.ticks:
        axes.set_yticks(list(panel.ticks), list(panel.ticks.values()))
    if panel.bounds != (None, None):
        axes.set_ylim(*panel.bounds)


def _add(axes: Axes, part: Part) -> None:
    how: dict[str, Any] = {"color": getattr(part, "color", None), "label": getattr(part, "label", "")}
    match part:
        case Curve(x, y, dashes=dashes, width=width, held=held):
            steps = "steps-post" if held else "default"
            axes.plot(x, y, ls=_dashes(dashes), lw=width, drawstyle=steps, rasterized=len(x) > MANY, **how)
        case Points(x, y, size=size, marker=marker):
            inside = marker != "right"  # an arrow stands at the edge
            axes.plot(x, y, MARKERS[marker], ms=size, mew=0.0, clip_on=inside, rasterized=len(x) > MANY, **how)
        case Band(x, low, high, alpha=alpha):
            axes.fill_between(x, low, high, alpha=alpha, lw=0.0, zorder=0.6, **how)
        case Bars(x, y, breadth, alpha=alpha):
            axes.bar(x, y, breadth, alpha=alpha, **how)
        case Spans(starts, ends, outlined=outlined):
            options = {"fill": False, "ec": "0.3", "lw": 0.8, "ls": "--"} if outlined else {"lw": 0.0, "zorder": 0.5}
            for start, end in zip(starts, ends, strict=True):
                axes.axvspan(start, end, alpha=part.alpha, **how, **options)
                how["label"] = ""
        case Level(at, color, dashes, width, upright):
            draw = axes.axvline if upright else axes.axhline
            draw(at, color=color, ls=_dashes(dashes), lw=width)
        case Arrow(at, low, high):
            arrow = {"arrowstyle": "<->", "lw": 0.7, "shrinkA": 0.0, "shrinkB": 0.0, "mutation_scale": 4.0}
            axes.annotate("", (at, high), (at, low), arrowprops=arrow)


def _dashes(dashes: Dashes) -> Any:
    """As matplotlib has them."""
    return (0.0, dashes) if dashes else "-"


def _note(row: Sequence[Axes], panels: Sequence[Panel], same_y: bool) -> None:
    """Notes in the upper right corners, and room for them above the curves."""
    lines = max(len(panel.note.splitlines()) for panel in panels)
    if not lines:
        return
    for axes, panel in zip(row, panels, strict=True):
        axes.text(1.0, 1.0, panel.note, transform=axes.transAxes, ha="right", va="top", fontsize=NOTE_SIZE)
    for axes in row[: 1 if same_y else None]:
        low, high = axes.get_ylim()
        axes.set_ylim(low, high + (high - low) * lines * NOTE_LINE / (1.0 - lines * NOTE_LINE))


def titled(figure: Figure, title: str, caption: str = "", size: float = 10.0) -> None:
    """A title above and a caption below, in as many lines as they need; `size` in points is that of the title."""
    figure.suptitle(_lines(figure, title, size), fontsize=size)
    if caption:
        figure.supxlabel(_lines(figure, caption, CAPTION_SIZE), fontsize=CAPTION_SIZE, color="0.4")


def _lines(figure: Figure, text: str, size: float) -> str:
    """The text in lines that are not wider than the figure; a dollar is one, not the begin of a formula."""
    width = int((figure.get_figwidth() - 0.4) * 72.0 / (CHARACTER * size))
    return "\n".join(fill(line, width) for line in text.replace("$", r"\$").splitlines())


def matrix_axes(axes: Axes, columns: Sequence[str], rows: Sequence[str], title: str) -> None:
    """Axes of cells of size 1, the first row on top."""
    axes.set_xticks(np.arange(len(columns)) + 0.5, columns, rotation=90)
    axes.set_yticks(np.arange(len(rows)) + 0.5, rows)
    axes.set_ylim(len(rows), 0)
    axes.tick_params(length=0)
    axes.grid(False)
    axes.spines[:].set_visible(False)
    axes.set_title(title)


def in_cell(axes: Axes, column: int, row: int, text: str, colour: str, size: float = 6.0) -> None:
    """Text in a cell of `matrix_axes`, which it does not leave: the layout need not ask for it."""
    at = column + 0.5, row + 0.5
    axes.text(*at, text, ha="center", va="center", fontsize=size, color=colour).set_in_layout(False)


def legend(axes: Axes, columns: int = 5) -> None:
    """A legend above the axes, where it covers no curve."""
    made = axes.legend(
        loc="lower left",
        bbox_to_anchor=(0.0, 1.0),
        ncols=columns,
        borderaxespad=0.0,
        handlelength=2.6,
        columnspacing=1.6,
    )
    made.set_in_layout(len(made.legend_handles) > columns)  # in one row there is room, also above the next column


def save(figure: Figure, stem: Path, kinds: Sequence[str] = USUAL_KINDS) -> list[Path]:
    """Writes a figure in files of these kinds (`harness.views.figure_options.KINDS`), without a date; returns them."""
    files, layout = [], figure.get_layout_engine()
    for kind in kinds:
        if kind == "png" and layout:  # whose resolution is that of the figure: it need not be drawn to be laid out
            layout.execute(figure)
            figure.set_layout_engine("none")
        files.append(stem.with_name(f"{stem.name}.{kind}"))
        with complete(files[-1]) as unfinished:
            figure.savefig(unfinished, dpi=DPI, format=kind, metadata=METADATA[kind])
        figure.set_layout_engine(layout)
    return files
