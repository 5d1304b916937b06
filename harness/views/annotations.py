"""What figures point out: the gap, the band in which a step has settled, its overshoot, rms values."""

from math import isnan

import numpy as np

from ..loop import roles
from ..manoeuvres.manoeuvre import Manoeuvre
from ..metrics.declaration import Absent
from ..metrics.evaluate import at_samples, evaluate
from ..metrics.oscillation import SETTLED
from ..metrics.run_metrics import Metrics
from ..metrics.step_response import height_of_step, response
from .colours import SKY
from .metrics_table import SHOWN, number
from .panels import Arrow, Band, Curve, Part, Spans
from .signal_lines import interval

BEFORE, AFTER = 0.1, 1.4
"""What is shown of a step, in s."""

TICK = 3.0
"""Of the band, where it has settled."""

GAP = "teeth apart"

BAND = f"settled: ± {100.0 * SETTLED:.0f} % of the step"

SAID = {"overshoot": "overshoot", "settling_time": "settling", "gear_torque_rms": "rms", "jerk_rms": "rms"}
"""How a note names a metric."""


def shown_at_first(manoeuvre: Manoeuvre) -> tuple[float, float]:
    """From and to when in s: the step, or else the whole manoeuvre."""
    if manoeuvre.dT is None:
        return 0.0, manoeuvre.duration
    return max(manoeuvre.t_0 - BEFORE, 0.0), min(manoeuvre.t_0 + AFTER, manoeuvre.duration)


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
        f"{SAID[metric.name]} {number(metric.of(metrics), column)} {column.printed_unit}"
        for metric, column in found
        if metrics and not isnan(metric.of(metrics))
    )


def gap(run: np.ndarray, label: str = "") -> Spans:
    """From and to when in s the gear torque is zero, as it is while the teeth are apart."""
    zero = np.concatenate(([False], run[roles.GEAR_TORQUE] == 0.0, [False]))
    edges = np.flatnonzero(zero[1:] != zero[:-1])
    begin, last = run["time"][edges[::2]], run["time"][edges[1::2] - 1]
    return Spans(begin, np.maximum(last, begin + interval(run)), label)


def marks_of_step(
    run: np.ndarray, manoeuvre: Manoeuvre, metrics: Metrics | None, window: tuple[float, float]
) -> list[Part]:
    """The band in which the gear torque has settled, when it has, and how far it overshoots.

    Args:
        metrics: of the run, see `metrics_of`.
    """
    if metrics is None:
        return []
    sampled = at_samples(run)
    t, T_gear = sampled["time"], sampled[roles.GEAR_TORQUE]
    try:
        dT = height_of_step(manoeuvre, t)
        step = response(t, T_gear, manoeuvre.t_0, dT)
    except Absent:
        return []
    final, after, band = step.final, t >= manoeuvre.t_0, SETTLED * abs(dT)
    marks: list[Part] = [Band(t[after], final[after] - band, final[after] + band, BAND, SKY, 0.4)]
    settled = manoeuvre.t_0 + metrics.settling_time
    if window[0] <= settled <= window[1]:
        tick = np.interp(settled, t, final) + TICK * band * np.array([-1.0, 1.0])
        marks.append(Curve(np.full(2, settled), tick))
    peak = step.first + int(step.y[step.first :].argmax())
    if metrics.overshoot >= SETTLED / 2.0 and window[0] <= t[peak] <= window[1]:
        marks.append(Arrow(t[peak], final[peak], T_gear[peak]))
    return marks
