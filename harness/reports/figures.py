"""Figures of the runs: without damping on the left, with damping on the right, on the same axes.

Every figure is written as PNG and PDF; the same runs give the same bytes.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from textwrap import fill

import numpy as np
from matplotlib import style
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.ticker import MaxNLocator

from ..manoeuvres.manoeuvre import Manoeuvre
from .colours import BLACK, BLUE, GREEN, GREY, VERMILION
from .files import complete

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
}

METADATA = {
    "png": {"Software": None},
    "pdf": {"CreationDate": None, "Producer": None, "Creator": None},
}
"""What matplotlib would say of date and origin, by the kind of file: nothing."""

CAPTION_SIZE = 7.5
"""In points."""

CHARACTER = 0.6
"""Width of a character of a title over its size; on average it is less."""

TITLES = ("without damping", "with damping")


@dataclass(frozen=True)
class Line:
    """How one column of the results is drawn."""

    column: str
    label: str
    color: str
    style: str = "-"
    width: float = 1.0


@dataclass(frozen=True)
class Panel:
    """One row of axes: its label and its lines, the later ones on top."""

    label: str
    lines: tuple[Line, ...]


DRIVE_PANELS = (
    Panel(r"motor speed $\omega_1$ in rad/s", (Line("plant.omega_1", r"$\omega_1$", BLACK),)),
    Panel(r"wheel speed $\omega_2$ in rad/s", (Line("plant.omega_2", r"$\omega_2$", BLACK),)),
    Panel(
        "torque in N·m",
        (
            Line("plant.T_rim", r"$T_{rim}/i$, wheel torque", VERMILION),
            Line("motor.T_mot", r"$T_{mot}$, motor", BLUE),
            Line("controller.T_driver", r"$T_{driver}$, demand", BLACK, "--", 0.8),
        ),
    ),
)
STEP_PANELS = (
    Panel(
        "gear torque in N·m",
        (
            Line("plant.T_gear", r"$T_{gear}$", VERMILION, "-", 1.4),
            Line("controller.T_gear_hat", r"$\hat T_{gear}$, estimate", BLUE, "-", 0.8),
            Line("controller.T_driver", r"$T_{driver}$, demand", BLACK, "--", 0.8),
        ),
    ),
    Panel(
        "motor torque in N·m",
        (
            Line("controller.T_ref", r"$T_{ref}$, to the motor", BLUE),
            Line("controller.T_damp", r"$T_{damp}$, damping", GREEN),
            Line("controller.T_driver", r"$T_{driver}$, demand", BLACK, "--", 0.8),
        ),
    ),
    Panel(
        "speed in rad/s",
        (
            Line("plant.omega_1", r"$\omega_1$, motor", BLACK),
            Line("plant.omega_2", r"$\omega_2$, wheels", GREY, "-", 1.4),
        ),
    ),
)


def plot_drive(
    runs: Sequence[np.ndarray], manoeuvre: Manoeuvre, plant: str, stem: Path, caption: str = ""
) -> list[Path]:
    """Speeds and torques over a whole drive, as in Figs. 7 and 8 of the paper.

    Args:
        runs: results without and with damping.
        manoeuvre: that both ran.
        plant: its name, for the title.
        stem: path of the files without their ending.
        caption: what was set, in small below.

    Returns:
        The files written.
    """
    title = f"{plant}, {manoeuvre.description}"
    return _compare(runs, DRIVE_PANELS, (0.0, manoeuvre.duration), title, stem, caption)


def plot_step(
    runs: Sequence[np.ndarray], manoeuvre: Manoeuvre, plant: str, stem: Path, caption: str = ""
) -> list[Path]:
    """Close-up of a step: gear torque with its estimate, damping torque and speeds.

    Arguments and result are those of `plot_drive`.
    """
    window = (manoeuvre.t_0 - 0.1, manoeuvre.t_0 + 1.4)
    return _compare(runs, STEP_PANELS, window, f"{plant}, {manoeuvre.description}", stem, caption)


def _compare(
    runs: Sequence[np.ndarray],
    panels: Sequence[Panel],
    window: tuple[float, float],
    title: str,
    stem: Path,
    caption: str,
) -> list[Path]:
    with style.context(STYLE):
        figure = Figure(figsize=(7.2, 2.0 * len(panels) + 0.7), layout=ConstrainedLayoutEngine(h_pad=0.11))
        grid = figure.subplots(len(panels), len(runs), sharex=True, sharey="row", squeeze=False)
        titled(figure, title, caption)
        for row, panel in zip(grid, panels, strict=True):
            row[0].set_ylabel(panel.label)
            for axes, run in zip(row, runs, strict=True):
                shown = (run["time"] >= window[0] - 1e-9) & (run["time"] <= window[1] + 1e-9)
                draw(axes, panel, run, shown)
            if len(panel.lines) > 1:
                legend(row[0])
        for axes, heading in zip(grid[0], TITLES, strict=True):
            axes.set_title(heading, pad=20 if len(panels[0].lines) > 1 else 6)
            axes.set_xlim(*window)
            axes.xaxis.set_major_locator(MaxNLocator(5))
        for axes in grid[-1]:
            axes.set_xlabel("time in s")
        return save(figure, stem)


def draw(axes: Axes, panel: Panel, run: np.ndarray, shown: np.ndarray) -> None:
    """The lines of a panel, at the instants that are shown, less those that FMUs of others do not have."""
    for line in panel.lines:
        if line.column in (run.dtype.names or ()):
            axes.plot(
                run["time"][shown],
                _signal(run, line.column)[shown],
                color=line.color,
                ls=line.style,
                lw=line.width,
                label=line.label,
            )


def _signal(run: np.ndarray, column: str) -> np.ndarray:
    """A column; the torque at the rims as seen from the motor."""
    return run[column] / _gear_ratio(run) if column == "plant.T_rim" else run[column]


def _gear_ratio(run: np.ndarray) -> float:
    """Motor speed over wheel speed, from the two measures of the wheel speed."""
    wheel = 0.5 * (run["plant.omega_wheel_L"] + run["plant.omega_wheel_R"])
    return float(np.dot(run["plant.omega_2"], wheel) / np.dot(wheel, wheel))


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


def legend(axes: Axes) -> None:
    """A legend above the axes, where it covers no curve."""
    made = axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=4, borderaxespad=0.0)
    made.set_in_layout(False)  # it may reach over the next column


def save(figure: Figure, stem: Path) -> list[Path]:
    """Writes a figure as PNG and PDF, without a date; returns the files."""
    files = []
    for kind, metadata in METADATA.items():
        files.append(stem.with_name(f"{stem.name}.{kind}"))
        with complete(files[-1]) as unfinished:
            figure.savefig(unfinished, dpi=200, format=kind, metadata=metadata)
    return files
