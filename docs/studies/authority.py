"""What the designed authority is worth: twelve cars with the default gains and limits, and with their own.

Steps of the demand are scaled with T_max. The estimator is told the true car in either case. Means over the noise of
three seeds.
"""

from collections.abc import Iterable, Mapping, Sequence
from itertools import product
from math import pi
from typing import NamedTuple

import numpy as np

from driveline.harness.design.design import design
from driveline.harness.design.design_weights import MOTOR, PLANT
from driveline.harness.design.loop_parameters import loop_parameters
from driveline.harness.loop.places import PLANTS
from driveline.harness.manoeuvres.catalogue import KMH, step
from driveline.harness.manoeuvres.manoeuvre import Manoeuvre
from driveline.harness.metrics.evaluate import evaluate
from driveline.harness.simulation.simulate import planned
from fmuloop.campaign import RunRequest
from fmuloop.many_runs import run_many
from fmuloop.results import Results

from .study import Cell, Column, Measured, Study, Table

SEEDS = (1, 2, 3)

STEPS = {
    "tip-in": (15 * KMH, -12.0, 100.0, 0.0),
    "tip-out": (50 * KMH, 100.0, -30.0, 0.0),
    "launch": (0.0, 0.0, 120.0, 0.1),
}
"""Start speed in m/s, torques in N.m before and after for the T_max of the default car, rise in s."""


class Car(NamedTuple):
    """What tells the cars apart, in SI units.

    Attributes:
        frequency: sqrt(C/J_1)/(2 pi) in Hz; that of the default car is 7.35.
        gap: over that of the default car, both at the wheel.
        grip: slip stiffness of the tyres over the weight, over that of the default car.
    """

    m: float
    T_max: float
    i: float
    r: float
    frequency: float
    tau: float
    gap: float
    grip: float = 1.0

    def entries(self) -> dict[str, float]:
        """Of a vehicle file; inertias are the shares of the vehicle's that they are in the default car."""
        M = self.m * self.r**2 / self.i**2
        share = PLANT.i**2 / (PLANT.m * PLANT.r**2)
        J_1 = PLANT.J_1 * share * M
        return {
            "m": self.m,
            "r": self.r,
            "i": self.i,
            "T_max": self.T_max,
            "tau": self.tau,
            "J_1": J_1,
            "J_2": PLANT.J_2 * share * M,
            "C": J_1 * (2.0 * pi * self.frequency) ** 2,
            "phi_B": PLANT.phi_B / PLANT.i * self.i * self.gap,
            "c_slip": PLANT.c_slip / PLANT.m * self.m * self.grip,
        }


CARS = {
    "small": Car(900.0, 150.0, 9.0, 0.28, 6.0, 0.003, 1.0),
    "small, narrow gap": Car(900.0, 150.0, 9.0, 0.28, 7.35, 0.002, 0.5),
    "compact, wide gap": Car(1450.0, 180.0, 9.0, 0.29, 7.35, 0.003, 2.0),
    "compact, stiff": Car(1450.0, 180.0, 9.0, 0.29, 10.0, 0.003, 1.0, 1.5),
    "compact, slow motor": Car(1450.0, 180.0, 9.0, 0.29, 7.35, 0.012, 1.0),
    "mid-size": Car(2200.0, 250.0, 10.5, 0.34, 7.7, 0.0025, 0.5),
    "sports": Car(1600.0, 400.0, 9.0, 0.33, 7.5, 0.002, 1.0),
    "direct, i = 3": Car(1450.0, 500.0, 3.0, 0.29, 7.35, 0.003, 1.0),
    "large": Car(2600.0, 310.0, 9.0, 0.36, 7.0, 0.004, 1.0),
    "van, wide gap": Car(3500.0, 280.0, 12.0, 0.35, 6.9, 0.003, 2.0),
    "light truck": Car(7500.0, 400.0, 16.0, 0.42, 6.5, 0.006, 1.5),
    "truck": Car(12000.0, 500.0, 20.0, 0.5, 6.0, 0.008, 1.0),
}


class Trial(NamedTuple):
    """A car, a plant and a step by name, with its own gains or the default ones."""

    car: str
    plant: str
    step: str
    own: bool


def manoeuvre(name: str, T_max: float) -> Manoeuvre:
    """A step of STEPS for a motor."""
    v_0, before, after, rise = STEPS[name]
    scale = T_max / MOTOR.T_max
    return step(name, name, v_0, scale * before, scale * after, rise)


def course(trial: Trial) -> Manoeuvre:
    return manoeuvre(trial.step, CARS[trial.car].entries()["T_max"])


def needed(trial: Trial) -> list[RunRequest]:
    """One with the noise of each seed."""
    car = CARS[trial.car].entries()
    gains: Mapping[str, float] = design(car) if trial.own else {}
    parameters = loop_parameters({**car, **gains}, trial.plant)
    return [planned(course(trial), trial.plant, parameters=parameters, seed=seed) for seed in SEEDS]


def measured(trial: Trial, results: Sequence[Results]) -> tuple[float, float]:
    """Settling time in ms and overshoot in %, each the mean over the seeds."""
    metrics = [evaluate(run, course(trial)) for run in results]
    settling, overshoot = np.mean([(1e3 * of.settling_time, 1e2 * of.overshoot) for of in metrics], axis=0)
    return float(settling), float(overshoot)


LIMITS = (Column("takes", "N.m", 0), Column("adds", "N.m", 0))
COLUMNS = (
    Column("overshoot", "%", 0),
    Column("overshoot, own", "%", 0),
    Column("settling", "ms", 0),
    Column("settling, own", "ms", 0),
)


def tables(cars: Iterable[str], plants: Iterable[str] = PLANTS) -> dict[str, Table]:
    """The limits of cars, and what their steps are with the default gains and limits, and with their own."""
    named, driven = list(cars), list(plants)
    gains = {car: design(CARS[car].entries()) for car in named}
    trials = [Trial(*combination) for combination in product(named, driven, STEPS, (False, True))]
    measures = dict(zip(trials, run_many(measured, trials, label="cars", runs=needed), strict=True))
    rows: dict[str, tuple[Cell, ...]] = {}
    for default in trials[::2]:
        pair = [measures[default], measures[default._replace(own=True)]]
        rows[f"{default.car}, {default.plant}, {default.step}"] = tuple(values[k] for k in (1, 0) for values in pair)
    limits = {car: (gains[car]["T_take_max"], gains[car]["T_add_max"]) for car in named}
    return {"limits": Table("car", LIMITS, limits), "steps": Table("car, plant, step", COLUMNS, rows)}


def measure() -> Measured:
    return Measured(tables(CARS))


def again() -> dict[str, Table]:
    return tables(SENTINELS, PLANTS[:1])


SENTINELS = ("van, wide gap",)

STUDY = Study(
    "what the designed authority is worth on twelve cars",
    measure,
    again,
    {"limits": SENTINELS, "steps": [f"{car}, {PLANTS[0]}, {step}" for car in SENTINELS for step in STEPS]},
    SEEDS,
    seconds=20,
)
