"""What the controller learns of the gap in twenty seconds with some twenty crossings, and what that is worth.

A car has another gap than its controller is told, some also another stiffness and mass. Tip-ins at 15 km/h follow, with
a controller that is told the true gap, with one that has learned it, and with one that takes it for the declared one.
"""

from itertools import product
from typing import NamedTuple

import numpy as np

from driveline.harness.design.uncertainty_box import Deviation, deviating
from driveline.harness.loop.places import PLACES, PLANTS, T_S
from driveline.harness.manoeuvres.catalogue import KMH, MANOEUVRES
from driveline.harness.manoeuvres.manoeuvre import Manoeuvre
from driveline.harness.manoeuvres.signals import lines
from driveline.harness.metrics.evaluate import at_samples, evaluate
from driveline.harness.simulation.simulate import simulate
from driveline.models.physics.vehicle import CAR
from fmuloop.many_runs import run_many

from .study import Column, Measured, Study, Table

SEEDS = (101, 102, 103)
LASTS = 20.0
"""Of a drive, s."""

STEP = MANOEUVRES["tipin15"]
GAPS = (0.45, 0.7, 1.0, 1.7, 2.4)
OTHERS = ((0.75, 1.0), (1.25, 1.0), (1.0, 0.75), (1.0, 1.25))
"""Stiffness and mass over the declared ones, with the declared gap."""


class Car(NamedTuple):
    """On a plant, with gap, stiffness and mass over the declared ones."""

    plant: str
    gap: float
    C: float = 1.0
    m: float = 1.0

    def __str__(self) -> str:
        others = "".join(f", {name} x {value:g}" for name, value in (("C", self.C), ("m", self.m)) if value != 1.0)
        return f"{self.plant}, gap x {self.gap:g}{others}"


def city(seed: int) -> Manoeuvre:
    """Torque to and fro, each for half a second to a second, after a step or a ramp."""
    draw, t, points = np.random.default_rng(seed), 0.6, [(0.0, -12.0), (0.6, -12.0)]
    while t < LASTS - 1.3:
        T_driver = -draw.uniform(10.0, 35.0) if points[-1][1] > 0.0 else draw.uniform(25.0, 130.0)
        begins, t = t + draw.choice([0.0, 0.0, 0.05, 0.1, 0.2, 0.3]), t + draw.uniform(0.6, 1.2)
        points += [(begins, T_driver), (max(t, begins), T_driver)]
    return Manoeuvre("city", "", LASTS, 15.0 * KMH, lines(*points))


class Found(NamedTuple):
    """Of a drive and tip-ins.

    Attributes:
        learned: gap over the true one after each quarter of the drive.
        told, known, declared: overshoot in %, and largest rate of the gear torque in N.m/ms.
    """

    learned: tuple[float, ...]
    told: tuple[float, float]
    known: tuple[float, float]
    declared: tuple[float, float]


def measured(case: tuple[Car, int]) -> Found:
    car, seed = case
    of_car = deviating({}, car.plant, PLACES["controller"][0], Deviation(phi_B=car.gap, C=car.C, m=car.m))
    driven = at_samples(simulate(city(seed), car.plant, parameters=of_car, seed=seed))["controller.phi_B_hat"]
    quarters = [driven[round(share * (len(driven) - 1))] for share in (0.25, 0.5, 0.75, 1.0)]

    def tip_in(**of_controller: float) -> tuple[float, float]:
        parameters = of_car | {f"controller.{name}": value for name, value in of_controller.items()}
        results = simulate(STEP, car.plant, parameters=parameters, seed=seed)
        rate = np.abs(np.diff(at_samples(results)["plant.T_gear"])).max() / T_S
        return 1e2 * evaluate(results, STEP).overshoot, 1e-3 * float(rate)

    true = car.gap * CAR.phi_B
    return Found(
        learned=tuple(float(phi_B) / true for phi_B in quarters),
        told=tip_in(phi_B=true, L_phi_B=0.0),
        known=tip_in(phi_B_0=float(quarters[-1])),
        declared=tip_in(L_phi_B=0.0),
    )


LEARNED = tuple(Column(f"after {LASTS * share:g} s", "", 2) for share in (0.25, 0.5, 0.75, 1.0))
SPREAD = (Column("least", "", 2), Column("most", "", 2))
TIP_INS = tuple(
    Column(f"{what}, {whose}", unit, decimals)
    for what, unit, decimals in (("overshoot", "%", 1), ("rate", "N.m/ms", 2))
    for whose in ("told", "learned", "declared")
)


def tables(cars: list[Car]) -> dict[str, Table]:
    """What is learned, and what it is worth."""
    cases = list(product(cars, SEEDS))
    gaps = dict(zip(cases, run_many(measured, cases, label="learned gap"), strict=True))
    learned, tip_ins = {}, {}
    for car in cars:
        of = [gaps[car, seed] for seed in SEEDS]
        quarters, last = np.mean([gap.learned for gap in of], axis=0), [gap.learned[-1] for gap in of]
        learned[str(car)] = (*map(float, quarters), min(last), max(last))
        if car.C == car.m == 1.0:
            means = np.mean([(gap.told, gap.known, gap.declared) for gap in of], axis=0)
            tip_ins[str(car)] = tuple(map(float, means.T.ravel()))
    note = f"Means over {len(SEEDS)} drives, over the true gap; least and most at the end."
    return {
        "learned": Table("car", (*LEARNED, *SPREAD), learned, note),
        "tip_ins": Table("car", TIP_INS, tip_ins, "Means of as many tip-ins."),
    }


SENTINELS = [Car(plant, 2.4) for plant in PLANTS]


def measure() -> Measured:
    cars = [Car(plant, gap) for plant in PLANTS for gap in GAPS]
    return Measured(tables(cars + [Car(plant, 1.0, *other) for plant in PLANTS for other in OTHERS]))


def again() -> dict[str, Table]:
    return tables(SENTINELS)


STUDY = Study(
    "what the controller learns of the gap, and what that is worth",
    measure,
    again,
    {name: list(map(str, SENTINELS)) for name in ("learned", "tip_ins")},
    SEEDS,
    seconds=15,
)
