"""Figure of one run: speeds, torques and the motion of the body, one above the other."""

from pathlib import Path

import numpy as np

from ..manoeuvres.manoeuvre import Manoeuvre
from .annotations import GAP, gap, in_words, marks_of_step, metrics_of
from .colours import GREEN, GREY
from .figure_options import PLAIN, FigureOptions
from .figure_style import draw
from .panels import DASH_DOT, Axis, Drawing, seen
from .signal_lines import (
    ACCELERATION,
    GEAR_TORQUE,
    JERK_UP_TO_50_HZ,
    KMH,
    MOTOR_TORQUE,
    SPEED_LABEL,
    SPEEDS,
    Line,
    Row,
    column,
    envelope_of,
)

ALL_SPEEDS = Row(
    SPEED_LABEL, (Line(column("can.omega_2_can"), r"$i\,\omega_{wheel}$ over CAN", GREEN, DASH_DOT, 0.8), *SPEEDS)
)
ENVELOPES = Row(
    "its envelope,\n5-50 Hz, in rad/s",
    (
        Line(envelope_of("plant.omega_2"), r"$i\,\omega_{wheel}$, wheels", GREY, width=1.8),
        Line(envelope_of("plant.omega_1"), r"$\omega_1$, motor", width=0.9),
    ),
)
VEHICLE = Row("speed of the\nvehicle in km/h", (Line(column("plant.v", KMH)),))


def plot_run(
    results: np.ndarray, manoeuvre: Manoeuvre, title: str, stem: Path, options: FigureOptions = PLAIN
) -> list[Path]:
    """Writes the figure of `run_drawing`.

    Args:
        results: of `driveline.simulate`.
        manoeuvre: that it is of.
        stem: path of the files without their ending.

    Returns:
        The files written.
    """
    return draw(run_drawing(results, manoeuvre, title, options), stem, options)


def run_drawing(results: np.ndarray, manoeuvre: Manoeuvre, title: str, options: FigureOptions = PLAIN) -> Drawing:
    """One run of the loop."""
    window = options.clipped(*map(float, results[[0, -1]]["time"]))
    metrics, apart = metrics_of(results, manoeuvre), seen(gap(results), *window)
    marks = [seen(mark, *window) for mark in marks_of_step(results, manoeuvre, metrics, window)]
    note = in_words(metrics, "overshoot", "settling_time", "gear_torque_rms")
    panels = [
        GEAR_TORQUE.of(results, apart, *marks, window=window, note=note),
        MOTOR_TORQUE.of(results, apart, window=window),
        ALL_SPEEDS.of(results, apart._replace(label=GAP), window=window),
        ENVELOPES.of(results, apart, window=window, bounds=(0.0, None)),
        ACCELERATION.of(results, apart, window=window),
        JERK_UP_TO_50_HZ.of(results, apart, window=window, note=in_words(metrics, "jerk_rms")),
        VEHICLE.of(results, apart, window=window),
    ]
    return Drawing([[panel] for panel in panels], Axis("time in s", window), title, (7.2, 1.35))
