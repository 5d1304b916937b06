"""How the metrics of a run depend on each parameter: of the car, which the controller does not notice, and its own."""

from collections.abc import Mapping, Sequence
from math import isnan, nan
from typing import Any, NamedTuple

import numpy as np

from ....fmus.building.parameter_files import OF_A_RUN
from ....models.block.declaration import Real, variables
from ...design.design_trials import loop_records
from ...metrics.declaration import declared
from ...metrics.run_metrics import Metrics

CHANGE = 0.1
"""By what share of itself each parameter is larger and smaller."""

MANOEUVRES = ("tipin15", "launch")

SHOWN = ("overshoot", "gear_torque_rms", "jerk_rms", "response_delay", "withheld_time")
"""The metrics whose dependence is computed."""

OF_THE_NOISE = ("T_s",)
"""Parameters that are none of a car or a controller."""


class Sensitivity(NamedTuple):
    """Of the metrics of a manoeuvre with a plant to a parameter.

    Attributes:
        changes: by metric, (M(1.1 p) - M(0.9 p))/(0.2 M(p)): by how many % the metric changes for 1 % of the parameter.
    """

    plant: str
    manoeuvre: str
    parameter: str
    changes: Mapping[str, float]

    @property
    def largest(self) -> float:
        """In magnitude."""
        return float(np.nanmax(np.abs([*self.changes.values(), 0.0])))


def varied(plant: str, controller: str, values: Mapping[str, Any]) -> dict[str, float]:
    """`instance.parameter` -> value of all that are changed, given the values that are set.

    Numbers that are zero, or that are not 10 % from their bounds, are left out.
    """
    found = {}
    for place, record in loop_records(plant, controller).items():
        for name, declaration, start in variables(record):
            if not isinstance(declaration, Real) or name in OF_A_RUN or name in OF_THE_NOISE:
                continue
            value = float(values.get(f"{place}.{name}", start))
            low, high = sorted(((1.0 - CHANGE) * value, (1.0 + CHANGE) * value))
            if value != 0.0 and declaration.minimum <= low and high <= declaration.maximum:
                found[f"{place}.{name}"] = value
    return found


def sensitivity(plant: str, manoeuvre: str, parameter: str, runs: Sequence[Metrics]) -> Sensitivity:
    """From the metrics of three runs, with the parameter smaller, as it is, and larger."""
    small, nominal, large = runs

    def change(name: str) -> float:
        values = [getattr(metrics, name) for metrics in (small, nominal, large)]
        if any(isnan(value) for value in values) or values[1] == 0.0:
            return nan
        return (values[2] - values[0]) / (2.0 * CHANGE * values[1])

    names = [metric.name for metric in declared(Metrics) if metric.name in SHOWN]
    return Sensitivity(plant, manoeuvre, parameter, {name: change(name) for name in names})
