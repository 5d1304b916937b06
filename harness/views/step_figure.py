"""Figure of a step: without damping on the left, with damping on the right, on the same axes."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib import style
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.ticker import MaxNLocator

from ..manoeuvres.manoeuvre import Manoeuvre
from .annotations import in_words, make_room, mark_step, metrics_of, note, shade_gap
from .figure_options import PLAIN, FigureOptions
from .figure_style import STYLE, legend, save, titled
from .signal_lines import ACCELERATION, GEAR_TORQUE, JERK_PANEL, MOTOR_TORQUE, SPEED_LABEL, SPEEDS, Panel, draw

TITLES = ("without damping", "with damping")

PANELS = (
    GEAR_TORQUE,
    Panel(MOTOR_TORQUE.label, MOTOR_TORQUE.lines[1:]),
    Panel(SPEED_LABEL, SPEEDS),
    ACCELERATION,
    JERK_PANEL,
)

AROUND = (-0.1, 1.4)
"""From and to when in s, after the step, is shown."""

HEIGHT = 1.55
"""Of a row, in inches."""


def plot_step(
    runs: Sequence[np.ndarray], manoeuvre: Manoeuvre, plant: str, stem: Path, options: FigureOptions = PLAIN
) -> list[Path]:
    """Gear torque with its estimate, band and overshoot, damping torque, speeds, motion of the body.

    Args:
        runs: results without and with damping.
        manoeuvre: that both ran, a step.
        plant: its name, for the title.
        stem: path of the files without their ending.

    Returns:
        The files written.
    """
    window = options.window or (manoeuvre.t_0 + AROUND[0], manoeuvre.t_0 + AROUND[1])
    with style.context(STYLE):
        figure = Figure(figsize=(7.2, HEIGHT * len(PANELS) + 0.9), layout=ConstrainedLayoutEngine(h_pad=0.11))
        grid = figure.subplots(len(PANELS), len(runs), sharex=True, sharey="row")
        titled(figure, f"{plant}, {manoeuvre.description}", options.caption)
        for column, run in zip(grid.T, runs, strict=True):
            for axes, panel in zip(column, PANELS, strict=True):
                draw(axes, panel, run, window)
            metrics = metrics_of(run, manoeuvre)
            mark_step(column[0], run, manoeuvre, metrics, window)
            shade_gap(column, run, window, column[2])
            note(
                column[0], f"{in_words(metrics, 'overshoot', 'settling_time')}\n{in_words(metrics, 'gear_torque_rms')}"
            )
            note(column[-1], in_words(metrics, "jerk_rms"))
            column[0].set_xlim(*window)
            column[0].xaxis.set_major_locator(MaxNLocator(5))
            column[-1].set_xlabel("time in s")
        make_room(grid[0, 0], 2)
        make_room(grid[-1, 0], 1)
        for (axes, _), panel in zip(grid, PANELS, strict=True):
            axes.set_ylabel(panel.label)
            if len(panel.lines) > 1:
                legend(axes)
        for axes, heading in zip(grid[0], TITLES, strict=True):
            axes.set_title(heading, pad=20)
        figure.align_ylabels()
        return save(figure, stem, options.kinds)
