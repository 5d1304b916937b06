"""Why there is no controller for a car: what of the car would have to be how much larger or smaller."""

from collections.abc import Mapping
from math import log, pi, sqrt
from typing import Any, NamedTuple

from ...fmus.building.estimates import DECIDE
from ...fmus.building.one_car import OF_CAR
from .design import gains_of
from .design_weights import WEIGHTS, Can, Motor, Plant, Weights, drive_train
from .kalman import DesignError

FURTHEST, HALVINGS = 4.0, 6
"""Factor within which a remedy is looked for, and how often that is halved, in its logarithm."""

MOST = 2
"""Remedies that are told, the least first."""


class Remedy(NamedTuple):
    """The value of one entry with which the design succeeds, and the factor on what it is."""

    name: str
    value: float
    factor: float

    def __str__(self) -> str:
        bound = "from" if self.factor > 1.0 else "up to"
        unit = OF_CAR[self.name][1].unit if self.name in OF_CAR else "s"
        return f"{self.name} {bound} {self.value:.3g} {unit} (here {self.value / self.factor:.4g})"


def cause(plant: Plant, motor: Motor, can: Can, weights: Weights = WEIGHTS) -> str:
    """How the drive train of a car without a controller swings, and what would do instead; to stand after a refusal."""
    frequency = drive_train(plant, motor, can, weights).omega_0 / (2.0 * pi)
    nearest = sorted(remedies(plant, motor, can, weights), key=lambda remedy: abs(log(remedy.factor)))[:MOST]
    instead = f"; {' or '.join(map(str, nearest))} would do" if nearest else ""
    return f": the drive train swings at {frequency:.2g} Hz{instead}"


def remedies(plant: Plant, motor: Motor, can: Can, weights: Weights) -> list[Remedy]:
    car = {"plant": plant, "motor": motor, "can": can}
    possible: list[Remedy] = []
    for place, record in car.items():
        for name in sorted({*DECIDE, "T_cyc", "d_max"} & {*record._fields}):
            for furthest in (FURTHEST, 1.0 / FURTHEST):
                if factor := _least(furthest, car, place, name, weights):
                    possible.append(Remedy(name, factor * getattr(record, name), factor))
    return possible


def _least(furthest: float, car: Mapping[str, Any], place: str, name: str, weights: Weights) -> float | None:
    """The factor up to the furthest one from which on there is a controller; None: with that one there is none."""

    def does(factor: float) -> bool:
        changed = car[place]._replace(**{name: factor * getattr(car[place], name)})
        try:
            gains_of(**{**car, place: changed}, weights=weights)
        except DesignError:
            return False
        return True

    if not does(furthest):
        return None
    fails = 1.0
    for _ in range(HALVINGS):
        middle = sqrt(fails * furthest)
        fails, furthest = (fails, middle) if does(middle) else (middle, furthest)
    return furthest
