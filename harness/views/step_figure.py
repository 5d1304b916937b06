"""Figure of a step: without damping on the left, with damping on the right, on the same axes."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ..manoeuvres.manoeuvre import Manoeuvre
from .annotations import GAP, gap, in_words, marks_of_step, metrics_of
from .figure_options import PLAIN, FigureOptions
from .figure_style import draw
from .panels import Axis, Drawing, Panel
from .signal_lines import ACCELERATION, GEAR_TORQUE, JERK_UP_TO_50_HZ, MOTOR_TORQUE, SPEED_LABEL, SPEEDS, Row

TITLES = ("without damping", "with damping")

TO_THE_MOTOR, BOTH_SPEEDS = Row(MOTOR_TORQUE.label, MOTOR_TORQUE.lines[1:]), Row(SPEED_LABEL, SPEEDS)

AROUND = (-0.1, 1.4)
"""From and to when in s, after the step, is shown."""


def plot_step(
    runs: Sequence[np.ndarray], manoeuvre: Manoeuvre, plant: str, stem: Path, options: FigureOptions = PLAIN
) -> list[Path]:
    """Writes the figure of `step_drawing`.

    Args:
        runs: results without and with damping.
        manoeuvre: that both ran, a step.
        plant: its name, for the title.
        stem: path of the files without their ending.

    Returns:
        The files written.
    """
    return draw(step_drawing(runs, manoeuvre, plant, options), stem, options)


def step_drawing(
    runs: Sequence[np.ndarray], manoeuvre: Manoeuvre, plant: str, options: FigureOptions = PLAIN
) -> Drawing:
    """Gear torque with its estimate, band and overshoot, damping torque, speeds, motion of the body."""
    window = options.window or (manoeuvre.t_0 + AROUND[0], manoeuvre.t_0 + AROUND[1])
    columns = [_panels(run, manoeuvre, window, title) for run, title in zip(runs, TITLES, strict=True)]
    rows = list(zip(*columns, strict=True))
    return Drawing(rows, Axis("time in s", window), f"{plant}, {manoeuvre.description}", (7.2, 1.57))


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
