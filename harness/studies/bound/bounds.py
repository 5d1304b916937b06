"""The bounds of the manoeuvres: what a controller reaches, what is possible at the same response, and runs of it.

The car is first linear along the run of the controller, then along the best torque that was found so.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from ....models.controller.supervision import Parameters
from ...cosimulation.parameter_changes import require_constant
from ...cosimulation.wiring import fit
from ...loop.places import PLANTS
from ...loop.settings import Settings, loop
from ...manoeuvres.catalogue import MANOEUVRES
from ...metrics.evaluate import at_samples, evaluate
from ...metrics.run_metrics import Metrics
from ...simulation.many_runs import run_many
from ...simulation.simulate import simulate, start
from ..margins.linear_plant import NOISELESS
from .bound_task import Task, task
from .contacts import Contacts
from .linear_car import linear_car
from .linear_prediction import value
from .open_loop_run import open_loop_run
from .programme import Solution
from .switching_search import FINE, Search

PLANT = PLANTS[0]
"""The design model."""

ALONE = ("gear_torque_rms", "jerk_rms_to_50_Hz", "impact_speed")
"""Metrics that are also made as small as possible alone; overshoot alone can be avoided."""


class Optimum(NamedTuple):
    """The best torque for some metrics, and what the nonlinear design model makes of it.

    Attributes:
        contacts: of the teeth.
        solution: of the convex programme.
        results, metrics: of the run that verifies it.
        deviation: largest difference in N.m of T_gear between that run and the programme.
    """

    contacts: Contacts
    solution: Solution
    results: np.ndarray
    metrics: Metrics
    deviation: float


class Bounded(NamedTuple):
    """A manoeuvre.

    Attributes:
        jointly: the smallest worst ratio of all metrics.
        bound: no torque reference has a smaller one for contacts that were looked at.
        neighbours: how many those are.
        alone: by metric, how small it can be with the others no worse than those of the controller.
    """

    task: Task
    jointly: Optimum
    bound: float
    neighbours: int
    alone: Mapping[str, Optimum]

    def ratio(self, optimum: Optimum) -> float:
        """The worst of the metrics of a verified optimum over those that are reached."""
        return max(getattr(optimum.metrics, n) / getattr(self.task.reached, n) for n in self.task.metrics)


def bounded(name: str, settings: Settings) -> Bounded:
    """The bounds of a manoeuvre for a controller.

    Args:
        name: of the manoeuvre.
        settings: of the loop with the design model, PLANT.

    Raises:
        SimulationError: the run of the controller lacks a metric.
    """
    manoeuvre = MANOEUVRES[name]
    require_constant(settings.parameters, "a bound")
    quiet = settings.with_parameters({f"motor.{n}": v for n, v in NOISELESS.items()})
    blocks = fit(loop(quiet)).parameters({**start(manoeuvre), **quiet.parameters})
    limits = {name: value for name, value in blocks["controller"].items() if name in Parameters._fields}
    given = task(manoeuvre, simulate(manoeuvre, quiet), Parameters(**limits))
    of_car = {f"{place}.{name}": value for place in ("plant", "motor") for name, value in blocks[place].items()}

    search = Search(given, linear_car(given.results, of_car, given.first), given.metrics)
    contacts = search.descend(given.contacts)
    first = _verified(search, contacts, search.solve(contacts), quiet)

    car = linear_car(first.results, of_car, given.first)
    search = Search(given, car, given.metrics)
    found = search.surround(contacts)
    best = min(found, key=lambda each: each.solution.ratio)
    jointly = _verified(search, best.contacts, best.solution, quiet)

    alone = {}
    for metric in (name for name in ALONE if name in given.metrics):
        search = Search(given, car, (metric,))
        contacts = search.descend(best.contacts)
        alone[metric] = _verified(search, contacts, search.solve(contacts, FINE), quiet)
    return Bounded(given, jointly, min(each.solution.bound for each in found), len(found), alone)


def all_bounded(names: Sequence[str], settings: Settings) -> list[Bounded]:
    """The bounds of some manoeuvres, on all cores."""
    return run_many(lambda name: bounded(name, settings), names, label="bounding")


def _verified(search: Search, contacts: Contacts, solution: Solution, settings: Settings) -> Optimum:
    given = search.task
    results = open_loop_run(given.manoeuvre, given.reference(solution.u), settings)
    expected = value(search.predictor.predict(contacts).T_gear(np.arange(len(given.times))), solution.u)
    deviation = np.abs(expected - at_samples(results)["plant.T_gear"][given.first :]).max()
    return Optimum(contacts, solution, results, evaluate(results, given.manoeuvre), float(deviation))
