"""What is bounded: a manoeuvre, what a controller reaches in it, and the limits that any torque has to keep."""

from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import Polynomial

from driveline.harness.manoeuvres.manoeuvre import Manoeuvre
from driveline.harness.metrics.evaluate import WINDOW, WITHHELD, at_samples, evaluate
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.metrics.step_response import fitted, initial_value
from driveline.models.controller import T_S
from driveline.models.controller.supervision import Parameters, limited
from fmuloop.errors import SimulationError

from .contacts import GAP, PARTS, Contacts
from .linear_prediction import Horizon

MARGIN = 6
"""Samples after 90 % of the way in which the teeth may still change their side."""

BOUNDED = ("overshoot", "gear_torque_rms", "jerk_rms_to_50_Hz", "impact_speed")
"""The metrics whose worst ratio is made as small as possible."""


LIMITS = Parameters()
"""Of the supervision, by default."""

KEPT = ("settling_time", "response_delay", "withheld_time")
"""Those that are no larger."""


class Task(NamedTuple):
    """Of one manoeuvre; samples are counted from the first that control can change.

    Attributes:
        reached: metrics of the controller, without noise.
        results: of its run.
        initial, way: of the gear torque in N.m, see `harness.metrics.step_response`.
        times: (samples,) in s.
        lower, upper: (free samples,) limits of the torque reference in N.m.
        contacts: of the teeth in the run.
    """

    manoeuvre: Manoeuvre
    reached: Metrics
    results: np.ndarray
    initial: float
    way: float
    times: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    horizon: Horizon
    contacts: Contacts

    @property
    def first(self) -> int:
        """The sample of the run from which samples are counted."""
        return round(self.manoeuvre.t_0 / T_S) + 1

    @property
    def dT(self) -> float:
        """Height of the step in N.m."""
        return self.manoeuvre.dT or 0.0

    @property
    def sign(self) -> float:
        """Of the step."""
        return 1.0 if self.dT > 0.0 else -1.0

    @property
    def metrics(self) -> tuple[str, ...]:
        """Those of BOUNDED that the manoeuvre has: without a gap to cross there is no impact."""
        return tuple(name for name in BOUNDED if getattr(self.reached, name) > 0.0)

    def sample(self, delay: float) -> int:
        """The sample that is `delay` s after the step."""
        return round(delay / T_S) - 1

    def reference(self, u: np.ndarray) -> np.ndarray:
        """(samples of the run,) the torque reference with the free part u, in N.m."""
        before = at_samples(self.results)["controller.T_ref"][: self.first]
        return np.concatenate([before, u, self.horizon.demand[len(u) :]])


def task(manoeuvre: Manoeuvre, results: np.ndarray, p: Any = LIMITS) -> Task:
    """What is bounded for a run of a controller.

    Args:
        results: of the manoeuvre, a step, with the design model and without noise.
        p: parameters of the supervision, which limit what is added to the demand.

    Raises:
        SimulationError: the run lacks a metric.
    """
    sampled, reached = at_samples(results), evaluate(results, manoeuvre)
    for name in (*BOUNDED, *KEPT):
        if name in reached.absent:
            raise SimulationError(f"{manoeuvre.name}: no bound without {name}: {reached.absent[name]}")
    t, T_gear = sampled["time"], sampled["plant.T_gear"]
    step = round(manoeuvre.t_0 / T_S)
    first = step + 1
    final = Polynomial.fit(t[fitted(t)], T_gear[fitted(t)], 1)
    initial = initial_value(T_gear, step)
    demand = np.asarray(manoeuvre.T_driver(t[first:] - T_S), dtype=float)
    free = round(WITHHELD / T_S)
    lower, upper = (
        np.clip([T + limited(limit, T, p) for T in demand[:free].tolist()], -p.T_max, p.T_max)
        for limit in (-np.inf, np.inf)
    )
    before = slice(step + round(WINDOW[0] / T_S), first)
    head = round(reached.response_delay / T_S) + MARGIN
    window = round((WINDOW[1] - WINDOW[0]) / T_S) + 1
    horizon = Horizon(demand, free, head, T_gear[before], sampled["plant.a_body"][before], window)
    way = float(final(t[step])) - initial
    sides = (int(np.sign(initial)), int(np.sign(initial + way)))
    contacts = _contacts(results, first, head, *sides)
    return Task(manoeuvre, reached, results, initial, way, t[first:], lower, upper, horizon, contacts)


def _contacts(results: np.ndarray, first: int, head: int, before: int, after: int) -> Contacts:
    """As the teeth touch in a run that begins on one side and ends on another."""
    if before == after:
        return Contacts((after,))
    rows = round(T_S / float(results["time"][1] - results["time"][0]))
    side = np.sign(results["plant.T_gear"][first * rows : (first + head) * rows])
    closes = max(int(np.argmax(side == after)) * PARTS // rows, 2)
    if before == GAP:
        return Contacts((GAP, after), (closes,))
    opens = int(np.argmax(side != before)) * PARTS // rows
    return Contacts((before, GAP, after), (max(min(opens, closes - 1), 1), closes))
