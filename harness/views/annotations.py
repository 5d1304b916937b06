"""What figures point out: the gap, the band in which a step has settled, its overshoot, rms values."""

from collections.abc import Iterator, Sequence
from math import isnan

import numpy as np
from matplotlib.axes import Axes

from ..manoeuvres.manoeuvre import Manoeuvre
from ..metrics.declaration import Absent
from ..metrics.evaluate import at_samples, evaluate
from ..metrics.run_metrics import Metrics
from ..metrics.step_response import SETTLED, height_of_step, response
from .colours import BLACK, SKY
from .metrics_table import SHOWN, number
from .signal_lines import interval

NOTE_SIZE = 7.5
"""In points."""

NOTE_LINE = 0.12
"""Of the height of axes, for a line of a note."""

TICK = 3.0
"""Of the band, where it has settled."""

GAP = "teeth apart"

BAND = f"settled: ± {100.0 * SETTLED:.0f} % of the step"

SAID = {
    "overshoot": "overshoot",
    "settling_time": "settling",
    "gear_torque_rms": "5-50 Hz rms",
    "jerk_rms": "5-50 Hz rms",
}
"""How a note names a metric."""

PRINTED = {"N.m": "N·m", "m/s3": "m/s³"}
"""Units as they are printed."""


def metrics_of(run: np.ndarray, manoeuvre: Manoeuvre) -> Metrics | None:
    """What a run is worth; None if its rows are too far apart, or of other instants than the controller's samples."""
    try:
        return evaluate(run, manoeuvre)
    except ValueError:
        return None


def in_words(metrics: Metrics | None, *names: str) -> str:
    """Metrics in words, those that have no value left out."""
    columns = {metric.name: (metric, column) for metric, column in SHOWN}
    found = [columns[name] for name in names]
    return ", ".join(
        f"{SAID[metric.name]} {number(metric.of(metrics), column)} {PRINTED.get(column.unit, column.unit)}"
        for metric, column in found
        if metrics and not isnan(metric.of(metrics))
    )


def note(axes: Axes, text: str) -> None:
    """A text in the upper right corner, above the curves: `make_room` has made room for it there."""
    axes.text(1.0, 1.0, text, transform=axes.transAxes, ha="right", va="top", fontsize=NOTE_SIZE)


def make_room(axes: Axes, lines: int) -> None:
    """Room above the curves for a note of so many lines."""
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + (high - low) * lines * NOTE_LINE / (1.0 - lines * NOTE_LINE))


def floating(run: np.ndarray) -> Iterator[tuple[float, float]]:
    """From and to when in s the gear torque is zero, as it is while the teeth are apart."""
    zero = np.concatenate(([False], run["plant.T_gear"] == 0.0, [False]))
    edges = np.flatnonzero(zero[1:] != zero[:-1])
    t = run["time"]
    for first, end in zip(edges[::2], edges[1::2], strict=True):
        yield float(t[first]), float(t[end - 1])


def shade_gap(rows: Sequence[Axes], run: np.ndarray, window: tuple[float, float], labelled: Axes | None = None) -> None:
    """Shades in all of these axes the time in which the teeth are apart.

    Args:
        labelled: the one whose legend says so.
    """
    least = interval(run)
    for start, end in floating(run):
        if start < window[1] and end > window[0]:
            for axes in rows:
                span = max(start, window[0]), min(max(end, start + least), window[1])
                axes.axvspan(*span, color="0.8", lw=0.0, zorder=0.5, label=GAP if axes is labelled else None)
                labelled = None if axes is labelled else labelled


def mark_step(
    axes: Axes, run: np.ndarray, manoeuvre: Manoeuvre, metrics: Metrics | None, window: tuple[float, float]
) -> None:
    """Marks in axes of the gear torque the band in which it has settled, when it has, and how far it overshoots.

    Args:
        metrics: of the run, see `metrics_of`.
    """
    if metrics is None:
        return
    sampled = at_samples(run)
    t, T_gear = sampled["time"], sampled["plant.T_gear"]
    try:
        dT = height_of_step(manoeuvre, t)
        step = response(t, T_gear, manoeuvre.t_0, dT)
    except Absent:
        return
    final = step.final
    shown = (t >= max(manoeuvre.t_0, window[0])) & (t <= window[1])
    band = SETTLED * abs(dT)
    axes.fill_between(
        t[shown], final[shown] - band, final[shown] + band, color=SKY, alpha=0.4, lw=0.0, zorder=0.6, label=BAND
    )
    settled = manoeuvre.t_0 + metrics.settling_time
    if window[0] <= settled <= window[1]:
        at = np.interp(settled, t, final)
        axes.vlines(settled, at - TICK * band, at + TICK * band, color=BLACK, lw=1.0)
    peak = step.first + int(step.y[step.first :].argmax())
    if metrics.overshoot >= SETTLED / 2.0 and window[0] <= t[peak] <= window[1]:
        arrow = {"arrowstyle": "<->", "color": BLACK, "lw": 0.7, "shrinkA": 0.0, "shrinkB": 0.0, "mutation_scale": 4.0}
        axes.annotate("", (t[peak], T_gear[peak]), (t[peak], final[peak]), arrowprops=arrow)
