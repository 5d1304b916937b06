"""Figure of one run: speeds, torques and the motion of the body, one above the other."""

from pathlib import Path

import numpy as np
from matplotlib import style
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from ..manoeuvres.manoeuvre import Manoeuvre
from .annotations import in_words, make_room, mark_step, metrics_of, note, shade_gap
from .colours import BLACK, GREEN, GREY
from .figure_options import PLAIN, FigureOptions
from .figure_style import STYLE, legend, save, titled
from .signal_lines import (
    ACCELERATION,
    DASH_DOT,
    GEAR_TORQUE,
    JERK_PANEL,
    KMH,
    MOTOR_TORQUE,
    SPEED_LABEL,
    SPEEDS,
    Line,
    Panel,
    column,
    draw,
    envelope_of,
)

PANELS = (
    GEAR_TORQUE,
    MOTOR_TORQUE,
    Panel(
        SPEED_LABEL,
        (Line(column("can.omega_2_can"), r"$i\,\omega_{wheel}$ over CAN", GREEN, DASH_DOT, 0.8), *SPEEDS),
    ),
    Panel(
        "its envelope,\n5-50 Hz, in rad/s",
        (
            Line(envelope_of("plant.omega_2"), r"$i\,\omega_{wheel}$, wheels", GREY, width=1.8),
            Line(envelope_of("plant.omega_1"), r"$\omega_1$, motor", BLACK, width=0.9),
        ),
    ),
    ACCELERATION,
    JERK_PANEL,
    Panel("speed of the\nvehicle in km/h", (Line(column("plant.v", KMH), "$v$, vehicle", BLACK),)),
)

HEIGHT = 1.35
"""Of a row, in inches."""


def plot_run(
    results: np.ndarray, manoeuvre: Manoeuvre, title: str, stem: Path, options: FigureOptions = PLAIN
) -> list[Path]:
    """Draws one run of the loop.

    Args:
        results: of `driveline.simulate`.
        manoeuvre: that it is of.
        stem: path of the files without their ending.

    Returns:
        The files written.
    """
    window = options.clipped(float(results["time"][0]), float(results["time"][-1]))
    metrics = metrics_of(results, manoeuvre)
    with style.context(STYLE):
        figure = Figure(figsize=(7.2, HEIGHT * len(PANELS) + 0.8), layout=ConstrainedLayoutEngine(h_pad=0.12))
        rows = figure.subplots(len(PANELS), 1, sharex=True)
        titled(figure, title, options.caption)
        for axes, panel in zip(rows, PANELS, strict=True):
            draw(axes, panel, results, window)
            axes.set_ylabel(panel.label)
        torque, _, speeds, envelopes, _, jerk, _ = rows
        mark_step(torque, results, manoeuvre, metrics, window)
        shade_gap(rows, results, window, speeds)
        for axes, names in ((torque, ("overshoot", "settling_time", "gear_torque_rms")), (jerk, ("jerk_rms",))):
            note(axes, in_words(metrics, *names))
            make_room(axes, 1)
        envelopes.set_ylim(bottom=0.0)
        for axes, panel in zip(rows, PANELS, strict=True):
            if len(panel.lines) > 1:
                legend(axes)
        rows[-1].set(xlabel="time in s", xlim=window)
        figure.align_ylabels()
        return save(figure, stem, options.kinds)
