"""How far the metrics depend on the communication step: every manoeuvre at that of the loop, and at a tenth of it."""

from collections.abc import Sequence
from math import inf
from pathlib import Path
from typing import NamedTuple

from driveline.harness.loop.places import BUILD, PLANTS, T_S
from driveline.harness.manoeuvres.catalogue import MANOEUVRES, USUAL_MANOEUVRES
from driveline.harness.metrics.declaration import declared
from driveline.harness.metrics.evaluate import evaluate
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.simulation.simulate import simulate

STEPS = (1e-3, 1e-4)
"""Communication steps in s that are compared."""

INSTANTS = ("crossing_time", "settling_time", "response_delay")
"""Metrics that are the time of a sample."""


class Case(NamedTuple):
    """A plant, a manoeuvre by its name, and whether damping is on."""

    plant: str
    manoeuvre: str
    control: bool


CASES = tuple(
    Case(plant, course.name, control) for plant in PLANTS for course in USUAL_MANOEUVRES for control in (False, True)
)


def deviations(coarse: Metrics, fine: Metrics) -> dict[str, float]:
    """Of the metrics that a run has, how far they are from those with the small step, as shares of these.

    A sample earlier or later is no deviation; a metric that only one of the runs has deviates without bound.
    """
    shares = {}
    for metric in declared(Metrics):
        if metric.name in coarse.absent and metric.name in fine.absent:
            continue
        away, value = abs(metric.of(coarse) - metric.of(fine)), abs(metric.of(fine))
        if away == 0.0 or (metric.name in INSTANTS and away < 1.01 * T_S):
            shares[metric.name] = 0.0
        else:
            shares[metric.name] = away / value if value > 0.0 and away < inf else inf
    return shares


def deviations_of(case: Case, folder: Path = BUILD, steps: Sequence[float] = STEPS) -> dict[str, float]:
    """The deviations of a case, with the FMUs in `folder`."""
    manoeuvre = MANOEUVRES[case.manoeuvre]
    coarse, fine = (
        evaluate(simulate(manoeuvre, case.plant, control=case.control, step_size=step, folder=folder), manoeuvre)
        for step in steps
    )
    return deviations(coarse, fine)
