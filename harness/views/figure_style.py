"""How all figures look and how they are written; the same results give the same bytes."""

from collections.abc import Sequence
from pathlib import Path
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..base.atomic_files import complete
from .figure_options import USUAL

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

CAPTION_SIZE = 7.5
"""In points."""

CHARACTER = 0.6
"""Width of a character of a title over its size; on average it is less."""


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


def save(figure: Figure, stem: Path, kinds: Sequence[str] = USUAL) -> list[Path]:
    """Writes a figure in files of these kinds (`harness.views.figure_options.KINDS`), without a date; returns them."""
    files = []
    for kind in kinds:
        files.append(stem.with_name(f"{stem.name}.{kind}"))
        with complete(files[-1]) as unfinished:
            figure.savefig(unfinished, dpi=200, format=kind, metadata=METADATA[kind])
    return files
