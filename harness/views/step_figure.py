"""Figure of a step: without damping on the left, with each controller to the right of it, on the same axes."""

from pathlib import Path

import numpy as np

from ..manoeuvres.manoeuvre import Manoeuvre
from .annotations import GAP, gap, in_words, marks_of_step, metrics_of, shown_at_first
from .figure_options import PLAIN, FigureOptions
from .figure_style import draw
from .panels import Axis, Drawing, Panel
from .signal_lines import ACCELERATION, GEAR_TORQUE, JERK_UP_TO_50_HZ, MOTOR_TORQUE, SPEED_LABEL, SPEEDS, Row, Runs

TO_THE_MOTOR, BOTH_SPEEDS = Row(MOTOR_TORQUE.label, MOTOR_TORQUE.lines[1:]), Row(SPEED_LABEL, SPEEDS)

NARROWEST = 2.6
"""Of a column, in inches."""


def plot_step(runs: Runs, manoeuvre: Manoeuvre, plant: str, stem: Path, options: FigureOptions = PLAIN) -> list[Path]:
    """Writes the figure of `step_drawing`.

    Args:
        runs: their results.
        manoeuvre: that all ran, a step.
        plant: its name, for the title.
        stem: path of the files without their ending.

    Returns:
        The files written.
    """
    return draw(step_drawing(runs, manoeuvre, plant, options), stem, options)


def step_drawing(runs: Runs, manoeuvre: Manoeuvre, plant: str, options: FigureOptions = PLAIN) -> Drawing:
    """Gear torque with its estimate, band and overshoot, damping torque, speeds, motion of the body."""
    window = options.window or shown_at_first(manoeuvre)
    rows = list(zip(*(_panels(run, manoeuvre, window, name) for name, run in runs.items()), strict=True))
    return Drawing(rows, Axis("time in s", window), f"{plant}, {manoeuvre.description}", size_of(runs))


def size_of(runs: Runs) -> tuple[float, float]:
    """Of a figure with a column for each run, and its height of a row, in inches."""
    return max(7.2, NARROWEST * len(runs)), 1.57


def _panels(run: np.ndarray, manoeuvre: Manoeuvre, window: tuple[float, float], heading: str) -> list[Panel]:
    metrics, apart = metrics_of(run, manoeuvre), gap(run)
    marks = marks_of_step(run, manoeuvre, metrics, window)
    note = f"{in_words(metrics, 'overshoot', 'settling_time')}\n{in_words(metrics, 'gear_torque_rms')}"
    return [
        GEAR_TORQUE.of(run, apart, *marks, heading=heading, note=note),
        TO_THE_MOTOR.of(run, apart),
        BOTH_SPEEDS.of(run, apart._replace(label=GAP)),
        ACCELERATION.of(run, apart),
        JERK_UP_TO_50_HZ.of(run, apart, note=in_words(metrics, "jerk_rms")),
    ]
