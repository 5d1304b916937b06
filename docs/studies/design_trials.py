"""What a design is worth: a car without damping, with the gains of the default car, and with its own."""

from collections.abc import Sequence
from enum import Enum
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from driveline.fmus.building.parameter_files import read_vehicle
from driveline.harness.design.design import design
from driveline.harness.design.loop_parameters import loop_parameters
from driveline.harness.loop.settings import Settings
from driveline.harness.loop.settings import settings as settings_of
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.manoeuvres.for_car import for_car, given_torque
from driveline.harness.metrics.declaration import declared
from driveline.harness.metrics.evaluate import evaluate
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.simulation.simulate import simulate


class Gains(Enum):
    """What the controller is given; the car that its estimator works with is always the true one."""

    NONE = "no damping"
    DEFAULT = "default gains"
    OWN = "own gains"


class Trial(NamedTuple):
    """A car by its vehicle file (None: the default car), a plant and a manoeuvre by name, and the gains."""

    vehicle: Path | None
    plant: str
    manoeuvre: str
    gains: Gains


@cache
def own_gains(vehicle: Path | None) -> dict[str, float]:
    """The gains designed for the car of a vehicle file."""
    return design(read_vehicle(vehicle) if vehicle else {})


def parameters(trial: Trial) -> dict[str, Any]:
    """What a trial gives the loop."""
    values = read_vehicle(trial.vehicle) if trial.vehicle else {}
    if trial.gains is Gains.OWN:
        values = values | own_gains(trial.vehicle)
    return loop_parameters(values, trial.plant)


def measured(trial: Trial, seeds: tuple[int, ...] = (1, 2, 3), settings: Settings | None = None) -> Metrics:
    """The metrics of a trial, each the mean over the seeds of the noise.

    Args:
        settings: of the runs beside what the trial says.
    """
    values, control = parameters(trial), trial.gains is not Gains.NONE
    manoeuvre = for_car(MANOEUVRES[trial.manoeuvre], given_torque(values))
    of_run = settings_of(settings, plant=trial.plant, control=control, parameters=values)
    return mean([evaluate(simulate(manoeuvre, of_run, seed=seed), manoeuvre) for seed in seeds])


def mean(runs: Sequence[Metrics]) -> Metrics:
    """Each metric as the mean over runs; it has no value where one of them has none."""
    means = {metric.name: float(np.mean([metric.of(metrics) for metrics in runs])) for metric in declared(Metrics)}
    return Metrics(**means, absent={name: why for metrics in runs for name, why in metrics.absent.items()})
