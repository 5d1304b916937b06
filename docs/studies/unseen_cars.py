"""Cars that no search has seen: drawn, designed for by `driveline design` alone, and driven on both plants.

A motor that gives each car 2 to 4 m/s2 drives it through the steps of the catalogue, in proportion to what it can do.
Beside ours stand the same gains without the shape of the demand, and the washout of the motor speed scaled to the car:
its frequencies as the drive train's, its damping as J_1 times that, with the authority that ours has.
"""

from collections.abc import Iterable, Mapping, Sequence
from itertools import product
from math import pi
from random import Random
from typing import NamedTuple

import numpy as np

from driveline.harness.design.design import AUTHORITY, design
from driveline.harness.design.loop_parameters import loop_parameters
from driveline.harness.loop.places import PLACES, PLANTS
from driveline.harness.loop.settings import Settings
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.manoeuvres.for_car import for_car
from driveline.harness.manoeuvres.manoeuvre import Manoeuvre
from driveline.harness.metrics.evaluate import evaluate
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.simulation.simulate import planned
from driveline.models.comparators.speed_washout import WashoutParameters
from driveline.models.physics.vehicle import CAR
from fmuloop.campaign import RunRequest
from fmuloop.many_runs import run_many
from fmuloop.results import Results

from .design_trials import mean
from .goals import STEPS
from .one_car import drawn, frequencies
from .study import Cell, Column, Measured, Study, Table, cell

CARS, SEED = 12, 40
NOISE = (301, 302, 303)

OURS, WASHOUT = PLACES["controller"][0], "SpeedWashout"
NONE, UNSHAPED = "no damping", "without the shape"
CHOICES = (NONE, OURS, UNSHAPED, WASHOUT)

Car = Mapping[str, float]


class Trial(NamedTuple):
    """A car on a plant, with one of CHOICES, in a manoeuvre."""

    car: str
    plant: str
    choice: str
    manoeuvre: str


def drawn_cars() -> dict[str, dict[str, float]]:
    """By name, with the largest torque of the motor."""
    random, cars = Random(SEED), {}
    for k in range(1, CARS + 1):
        car = drawn(random)
        cars[f"car {k}"] = {**car, "T_max": random.uniform(2.0, 4.0) * car["m"] * car["r"] / car["i"]}
    return cars


UNSEEN = drawn_cars()


def gains(car: Car, choice: str) -> Car:
    """Of the controller that is chosen."""
    designed = design(car)
    if choice != WASHOUT:
        return designed | (dict.fromkeys(("shape_1", "shape_2"), 0.0) if choice == UNSHAPED else {})
    usual, own = (2.0 * pi * frequencies(entries).design for entries in ({}, car))
    of = WashoutParameters()
    inertia = car["J_1"] / CAR.J_1
    scaled = {"k_v": of.k_v * inertia * own / usual, "omega_v": of.omega_v * own / usual}
    return scaled | {name: designed[name] for name in AUTHORITY}


def course(trial: Trial) -> Manoeuvre:
    return for_car(MANOEUVRES[trial.manoeuvre], UNSEEN[trial.car]["T_max"])


def needed(trial: Trial) -> list[RunRequest]:
    """One with the noise of each of three seeds."""
    car = UNSEEN[trial.car]
    controller = WASHOUT if trial.choice == WASHOUT else OURS
    parameters = loop_parameters({**car, **gains(car, trial.choice)}, trial.plant, controller)
    its = Settings(plant=trial.plant, controller=controller, control=trial.choice != NONE, parameters=parameters)
    return [planned(course(trial), its, seed=seed) for seed in NOISE]


def measured(trial: Trial, results: Sequence[Results]) -> Metrics:
    """Means over the seeds."""
    return mean([evaluate(run, course(trial)) for run in results])


class Shown(NamedTuple):
    """Of a car on a plant with one of CHOICES: means over the steps.

    Attributes:
        overshoot: in %.
        withheld: in ms.
        delay: by which 90 % are reached later than without damping, in ms.
        jerk: ratio of its rms up to 50 Hz to that without damping.
    """

    overshoot: float
    withheld: float
    delay: float
    jerk: float


COLUMNS = (
    Column("overshoot", "%", 1),
    Column("withheld", "ms", 1),
    Column("90 % later", "ms", 0),
    Column("jerk ratio", "", 2),
)

Found = Mapping[tuple[str, str, str], Shown]
"""By car, plant and choice."""


def shown(names: Iterable[str], plants: Iterable[str] = PLANTS) -> dict[tuple[str, str, str], Shown]:
    """Of cars by their names."""
    todo = [Trial(*combination) for combination in product(names, plants, CHOICES, STEPS)]
    of = dict(zip(todo, run_many(measured, todo, label="unseen cars", runs=needed), strict=True))
    by_key: dict[tuple[str, str, str], Shown] = {}
    for name, plant, choice in dict.fromkeys(trial[:3] for trial in todo):
        its = [of[Trial(name, plant, choice, manoeuvre)] for manoeuvre in STEPS]
        off = [of[Trial(name, plant, NONE, manoeuvre)] for manoeuvre in STEPS]
        by_key[name, plant, choice] = Shown(
            overshoot=1e2 * average(metrics.overshoot for metrics in its),
            withheld=1e3 * average(metrics.withheld_time for metrics in its),
            delay=1e3 * average(a.response_delay - b.response_delay for a, b in zip(its, off, strict=True)),
            jerk=average(a.jerk_rms_to_50_Hz / b.jerk_rms_to_50_Hz for a, b in zip(its, off, strict=True)),
        )
    return by_key


def average(values: Iterable[float]) -> float:
    return float(np.mean(list(values)))


def cars_table(by_key: Found) -> Table:
    rows = {", ".join(key): tuple(map(cell, numbers)) for key, numbers in by_key.items()}
    return Table("car, plant, controller", COLUMNS, rows)


def means_table(by_key: Found) -> Table:
    """Over the cars, and the worst overshoot of one."""
    columns = (Column("worst overshoot", "%", 1), *COLUMNS)
    rows: dict[str, tuple[Cell, ...]] = {}
    for plant, choice in product(PLANTS, CHOICES):
        of = [numbers for key, numbers in by_key.items() if key[1:] == (plant, choice)]
        rows[f"{plant}, {choice}"] = (max(numbers.overshoot for numbers in of), *map(average, zip(*of, strict=True)))
    return Table("plant, controller", columns, rows)


DRAWN = ("m", "r", "i", "J_1", "J_2", "C", "phi_B", "c_slip", "T_max")


def drawn_table() -> Table:
    """The cars, in the units of a vehicle file, and the frequency of their drive trains in the design model."""
    rows = {name: (frequencies(car).design, *(car[entry] for entry in DRAWN)) for name, car in UNSEEN.items()}
    return Table("car", (Column("drive train", "Hz", 1), *map(Column, DRAWN)), rows)


def measure() -> Measured:
    by_key = shown(UNSEEN)
    return Measured({"means": means_table(by_key), "cars": cars_table(by_key), "drawn": drawn_table()})


SENTINEL = "car 1"


def again() -> dict[str, Table]:
    return {"cars": cars_table(shown([SENTINEL], PLANTS[:1]))}


STUDY = Study(
    "what the damping is worth on cars that no search has seen",
    measure,
    again,
    {"cars": [", ".join((SENTINEL, *combination)) for combination in product(PLANTS[:1], CHOICES)]},
    (SEED, *NOISE),
    seconds=60,
)
