"""What follows from a car on a page, as data that the functions of `one_car` have made.

A page solves for what is elastic as `of_one_car` does: both plants, whose rates of change are in its module, are to
swing at frequencies as far apart as those of the default car. All else that follows is a product of powers.
"""

from collections.abc import Mapping
from math import log, log2
from typing import Any

from ...fmus.building import one_car
from ...fmus.building.one_car import DEFAULT_CAR, DESIGN, DETAILED, FOLLOW, SHAFTS
from ...fmus.building.oscillation import DRY_AND_SMOOTH, SPEED, rolling_torque
from ..metrics.spectrum import DRIVE_TRAIN, FREQUENCY, own_band


def following(known: Mapping[str, Any], frequency: float | None = None) -> dict[str, Any]:
    """
    Args:
        known: entries of the vehicle file that was given.
        frequency: at which the drive train swings where none was, Hz; None: that of the default car.
    """
    car = {name: float(value) for name, value in known.items() if name in DEFAULT_CAR}
    without_shafts = {name: value for name, value in car.items() if name not in SHAFTS}
    return {
        "known": car,
        "usual": dict(DEFAULT_CAR),
        "shafts": list(SHAFTS),
        "digits": one_car.DIGITS,
        "apart": one_car.frequencies_apart(),
        "close": log(1.0 + one_car.APART),
        "furthest": one_car.FURTHEST,
        "C": list(one_car.DECLARED["C"][1].bounds()),
        "band": {"edges": DRIVE_TRAIN, "frequency": FREQUENCY, "unturned": own_band(frequency)},
        "powers": {"known": _powers(car), "without": _powers(without_shafts)},
        "design": _plant(DESIGN, car, "m"),
        "detailed": _plant(DETAILED, car, "F_z0"),
    }


def _powers(car: Mapping[str, float]) -> dict[str, dict[str, Any]]:
    """Of each parameter that follows its value in the car, and of what it follows from that value and the exponent;
    `factor` is that of what is elastic."""
    sources = {name: car.get(name, DEFAULT_CAR[name]) for name in ("J_2", "i", "m")}
    before = one_car.with_details(car, 1.0)
    twice = {name: one_car.with_details({**car, name: 2.0 * value}, 1.0) for name, value in sources.items()}
    twice["factor"] = one_car.with_details(car, 2.0)
    sources["factor"] = 1.0

    def of(name: str) -> dict[str, tuple[float, float]]:
        powers = {source: round(log2(full[name] / before[name]), 9) for source, full in twice.items()}
        return {source: (sources[source], power) for source, power in powers.items() if power}

    return {name: {"value": before[name], "of": of(name)} for name in FOLLOW if name not in car}


def _plant(block: Any, car: Mapping[str, float], load: str) -> dict[str, Any]:
    """How the frequency of a plant is found: its conditions, and the torque as a straight line over its load."""
    names = block.Parameters._fields
    parameters = block.Parameters(**{name: car[name] for name in names if name in car})
    at = [rolling_torque(parameters._replace(**{load: value})) for value in (0.0, 1.0)]
    return {
        "fmu": block.name,
        "names": [name for name in names if name in DEFAULT_CAR],
        "here": {name: float(value) for name, value in {"v_0": SPEED, **DRY_AND_SMOOTH}.items() if name in names},
        "load": load,
        "torque": [at[0], at[1] - at[0]],
        "states": len(block.State._fields),
        "state": block.State._fields.index("omega_1"),
    }
