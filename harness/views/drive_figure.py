"""Figure of a whole drive: speeds and torques as in Figs. 7 and 8 of the paper, and what is too fast to show there."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib import style
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.ticker import MaxNLocator

from ..manoeuvres.manoeuvre import Manoeuvre
from ..metrics.band_filter import envelope
from ..metrics.run_metrics import Metrics
from .annotations import in_words, metrics_of, shade_gap
from .colours import BLACK, BLUE, ORANGE, VERMILION
from .figure_options import PLAIN, FigureOptions
from .figure_style import STYLE, legend, save, titled
from .signal_lines import DASHED, DEMAND, T_GEAR, T_RIM, WHEEL, Line, Panel, column, draw, envelope_of, interval, within
from .step_figure import HEIGHT, TITLES

T_MOT = Line(column("motor.T_mot"), r"$T_{mot}$, motor", BLUE, DASHED, 0.9)

PANELS = (
    Panel("motor speed\n" r"$\omega_1$ in rad/s", (Line(column("plant.omega_1"), r"$\omega_1$", BLACK),)),
    Panel("wheel speed in\nrad/s, wheel side", (Line(WHEEL, r"$\omega_{wheel}$", BLACK),)),
    Panel("torque in N·m,\nmotor side", (Line(T_RIM, r"$T_{rim}/i$, wheel torque", VERMILION), T_MOT, DEMAND)),
)

CLOSE_UP = Panel("torque in N·m,\nclose-up", (T_GEAR, T_MOT, DEMAND))

AROUND = (-0.3, 0.9)
"""From and to when in s, after the demand has changed its sign, the close-up is."""


def plot_drive(
    runs: Sequence[np.ndarray], manoeuvre: Manoeuvre, plant: str, stem: Path, options: FigureOptions = PLAIN
) -> list[Path]:
    """Speeds and torques, a close-up of one reversal of the torque, and the envelope of the gear torque.

    Arguments and result are those of `harness.views.step_figure.plot_step`.
    """
    window = options.clipped(0.0, manoeuvre.duration)
    closer = reversal(runs[0], window)
    rows = len(PANELS) + bool(closer) + 1
    with style.context(STYLE):
        figure = Figure(figsize=(7.2, HEIGHT * rows + 0.9), layout=ConstrainedLayoutEngine(h_pad=0.11))
        titled(figure, f"{plant}, {manoeuvre.description}", options.caption)
        grid = figure.subplots(rows, len(runs), sharey="row")
        for axes in grid[-1]:
            axes.remove()
        metrics = [metrics_of(run, manoeuvre) for run in runs]
        _envelopes(figure.add_subplot(grid[-1, 0].get_gridspec()[-1, :]), runs, metrics, window)
        whole, torque = grid[: len(PANELS)], grid[len(PANELS) - 1]
        _row_by_row(whole, PANELS, runs, window)
        for axes, heading in zip(whole[0], TITLES, strict=True):
            axes.set_title(heading)
        for axes in whole[:-1].flat:
            axes.tick_params(labelbottom=False)
        if closer:
            _row_by_row(grid[len(PANELS) : -1], [CLOSE_UP], runs, closer)
            for axes in torque:
                axes.axvspan(*closer, fill=False, ec="0.3", lw=0.8, ls="--")
        for row in grid[len(PANELS) - 1 : -1]:
            legend(row[0])
        figure.align_ylabels()
        return save(figure, stem, options.kinds)


def _row_by_row(
    grid: np.ndarray, panels: Sequence[Panel], runs: Sequence[np.ndarray], window: tuple[float, float]
) -> None:
    """Draws panels, a row each, of which the last one says the time; where there are torques the gap is shaded."""
    for row, panel in zip(grid, panels, strict=True):
        row[0].set_ylabel(panel.label)
        for axes, run in zip(row, runs, strict=True):
            draw(axes, panel, run, window)
            axes.set_xlim(*window)
            axes.xaxis.set_major_locator(MaxNLocator(5))
    for axes, run in zip(grid[-1], runs, strict=True):
        shade_gap([axes], run, window, axes if panels[-1] is CLOSE_UP else None)
        axes.set_xlabel("time in s")


def _envelopes(
    axes: Axes, runs: Sequence[np.ndarray], metrics: Sequence[Metrics | None], window: tuple[float, float]
) -> None:
    """The gear torque of all runs from 5 to 50 Hz, where the curves themselves would only cover each other."""
    looks = ((ORANGE, 1.8), (BLUE, 1.0))
    for run, of, heading, (color, width) in zip(runs, metrics, TITLES, looks, strict=True):
        label = ", ".join(filter(None, (heading, in_words(of, "gear_torque_rms"))))
        draw(axes, Panel("", (Line(envelope_of("plant.T_gear"), label, color, width=width),)), run, window)
    axes.set(ylabel="gear torque, 5-50 Hz\nenvelope in N·m", xlabel="time in s", xlim=window)
    axes.set_ylim(bottom=0.0)
    legend(axes)


def reversal(undamped: np.ndarray, window: tuple[float, float]) -> tuple[float, float] | None:
    """About the change of the sign of the demand, within a window, after which the gear torque swings most; None if
    there is none."""
    t, side = undamped["time"], np.sign(undamped["controller.T_driver"])
    loaded = np.flatnonzero(side)
    turns = loaded[1:][np.diff(side[loaded]) != 0]
    turns = turns[within(undamped, window)[turns]]
    if not len(turns):
        return None
    T_s = interval(undamped)
    swing = envelope(undamped["plant.T_gear"], T_s)
    after = round(AROUND[1] / T_s)
    turn = max(turns, key=lambda k: float(swing[k : k + after].max()))
    return max(float(t[turn]) + AROUND[0], window[0]), min(float(t[turn]) + AROUND[1], window[1])
