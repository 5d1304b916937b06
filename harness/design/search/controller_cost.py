"""What a controller costs: one list of terms over many runs, each against what a reference makes of the same run.

A term is the ratio of a metric to that of the reference, which therefore costs 1. Of the ratios the mean of the
fourth powers is taken (and its fourth root): what becomes worse counts more than what becomes better, and a bad
corner is not hidden by the good ones. The reference is a run with damping, because without it there is nothing that
stands for every corner: a launch without backlash hardly overshoots, whoever damps it.
"""

from collections.abc import Iterable, Sequence
from math import isnan
from typing import NamedTuple

from ...metrics.run_metrics import Metrics
from .tuning_runs import LASTS, Run

POWER = 4
LOST = 10.0
"""Ratio of a metric that the reference has and the controller has not."""

CONTRAST = 4.0
"""Factor on the weight of comfort, and its inverse on that of response, from the middle to an end of the scale."""


class Term(NamedTuple):
    """A metric in the cost.

    Attributes:
        metric: its name, see `harness.metrics.run_metrics`.
        weight: how much it counts within its group.
        floor: in the unit of the metric: a difference of much less does not matter.
    """

    metric: str
    weight: float
    floor: float


class Costs(NamedTuple):
    """Costs by groups of terms, each 1 for the reference."""

    swing: float
    comfort: float
    response: float

    def total(self, character: float = 0.5) -> float:
        """All in one, for a driver's choice from 0, sport, to 1, comfort."""
        lean = CONTRAST ** (2.0 * character - 1.0)
        return _mean(zip((1.0, lean, 1.0 / lean), self, strict=True))


TERMS: dict[str, tuple[Term, ...]] = {
    "swing": (
        Term("settling_time", 1.0, 0.02),
        Term("gear_torque_rms", 1.0, 0.3),
        Term("impact_speed", 0.5, 2.0),
        Term("impact_speed_90", 0.25, 2.0),
        Term("plateau_swing", 1.0, 0.1),
        Term("stationary_torque_change", 0.25, 0.05),
    ),
    "comfort": (
        Term("overshoot", 1.0, 0.03),
        Term("jerk_rms_to_50_Hz", 1.0, 0.5),
    ),
    "response": (
        Term("response_delay", 3.0, 0.0),
        Term("withheld_time", 1.0, 0.003),
        Term("crossing_time", 0.5, 0.01),
    ),
}
"""What counts, by the groups of `Costs`."""


def costs(runs: Sequence[Run], metrics: Sequence[Metrics], reference: Sequence[Metrics]) -> Costs:
    """The costs of a controller.

    Args:
        found, reference: metrics of the runs with it and with the reference.
    """

    def of(terms: tuple[Term, ...]) -> float:
        return _mean(
            (run.weight * term.weight, r)
            for run, its, other in zip(runs, metrics, reference, strict=True)
            for term in terms
            if (r := ratio(term, run, its, other)) is not None
        )

    return Costs(**{group: of(terms) for group, terms in TERMS.items()})


def ratio(term: Term, run: Run, own: Metrics, reference: Metrics) -> float | None:
    """A term of a run; None if the reference does not have the metric."""
    value, other = (_magnitude(term.metric, run, metrics) for metrics in (own, reference))
    if isnan(other):
        return None
    return LOST if isnan(value) else (value + term.floor) / (other + term.floor)


def _magnitude(metric: str, run: Run, metrics: Metrics) -> float:
    """Magnitude of a metric; what has not settled when the run ends is taken to settle then."""
    value = getattr(metrics, metric)
    if metric == "settling_time" and isnan(value) and run.manoeuvre.dT is not None:
        return LASTS
    return abs(value)


def _mean(weighted: Iterable[tuple[float, float]]) -> float:
    """Fourth root of the mean of the fourth powers of values, each with its weight."""
    weights, values = zip(*weighted, strict=True)
    total = sum(w * value**POWER for w, value in zip(weights, values, strict=True))
    return float((total / sum(weights)) ** (1.0 / POWER))
