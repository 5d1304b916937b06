"""What a design is worth: a car without damping, with the gains of the default car, and with its own."""

from collections.abc import Mapping, Sequence
from enum import Enum
from functools import cache
from math import inf
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...fmus.building.own_file import fmu_of
from ...fmus.building.parameter_files import for_instances, read_vehicle
from ..loop.places import PLACES
from ..loop.settings import Settings
from ..loop.settings import settings as settings_of
from ..manoeuvres.catalogue import MANOEUVRES
from ..manoeuvres.for_car import for_car
from ..metrics.declaration import declared
from ..metrics.evaluate import evaluate
from ..metrics.run_metrics import Metrics
from ..simulation.simulate import simulate
from .design import design


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


def loop_records(plant: str, controller: str = PLACES["controller"][0]) -> dict[str, Any]:
    """The declared parameters of the blocks of a loop, by their places, with a plant and a controller of ours."""
    blocks = {place: names[0] for place, names in PLACES.items()} | {"plant": plant, "controller": controller}
    return {place: fmu_of(name).block.Parameters for place, name in blocks.items()}


def loop_parameters(values: Mapping[str, Any], plant: str, controller: str = PLACES["controller"][0]) -> dict[str, Any]:
    """Entries of parameter files as parameters of the loop with a plant and a controller of ours.

        van = driveline.read_files(Path("van.toml"), Path("van_gains.toml"))
        driveline.simulate(tipin, "ValidationVehicle", parameters=driveline.loop_parameters(van, "ValidationVehicle"))

    Returns:
        `instance.name` -> value, for every block that has the name.
    """
    records = loop_records(plant, controller)
    return for_instances(values, {place: record._fields for place, record in records.items()})


def controller_parameters(values: Mapping[str, Any], plant: str) -> dict[str, Any]:
    """Of `loop_parameters` those of the controller alone: what it assumes, whatever the car is."""
    return {name: value for name, value in loop_parameters(values, plant).items() if name.startswith("controller.")}


def settled(
    plant: str, manoeuvre: str, parameters: Mapping[str, Any], seed: int = 1, settings: Settings | None = None
) -> tuple[float, float]:
    """Settling time in s and overshoot (1) of a loop with damping, parameters as `instance.name` -> value; settings of
    the run beside those."""
    course, made = (
        for_car(MANOEUVRES[manoeuvre], parameters.get("motor.T_max", inf)),
        settings_of(settings, plant=plant, parameters=parameters, seed=seed),
    )
    metrics = evaluate(simulate(course, made), course)
    return metrics.settling_time, metrics.overshoot


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
    given, control = parameters(trial), trial.gains is not Gains.NONE
    manoeuvre = for_car(MANOEUVRES[trial.manoeuvre], given.get("motor.T_max", inf))
    made = settings_of(settings, plant=trial.plant, control=control, parameters=given)
    return mean([evaluate(simulate(manoeuvre, made, seed=seed), manoeuvre) for seed in seeds])


def mean(found: Sequence[Metrics]) -> Metrics:
    """Each metric as the mean over runs; it has no value where one of them has none."""
    means = {metric.name: float(np.mean([metric.of(metrics) for metrics in found])) for metric in declared(Metrics)}
    return Metrics(**means, absent={name: why for metrics in found for name, why in metrics.absent.items()})
