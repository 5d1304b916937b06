"""Gains for a car that has become known: no worse than those that it had, as far as what is known of it goes."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ..loop.places import PLANTS
from ..loop.settings import Settings
from ..loop.settings import settings as settings_of
from ..manoeuvres.catalogue import MANOEUVRES
from ..manoeuvres.for_car import for_car, given_torque
from ..metrics.evaluate import evaluate
from ..simulation.simulate import simulate
from .design import design
from .design_weights import WEIGHTS, Weights
from .loop_parameters import controller_parameters, loop_parameters

REDESIGN_MANOEUVRES = ("tipin15", "tipin0", "tipout", "launch")
"""In which controllers are compared."""

SOFTER, SOFTEST = 0.8, 0.25
"""Factor on the washout's frequency from one design to the next, and the last of them."""

MARGIN = 0.95
"""Of the overshoot before, at which it is surely no worse: noise and sensors of the true car are not known."""


def worth(
    plant: str, manoeuvre: str, car: Mapping[str, Any], assumed: Mapping[str, Any], settings: Settings | None = None
) -> tuple[float, float]:
    """Settling time in s and overshoot (1) of a car whose controller assumes another one.

    Args:
        car: entries of a vehicle file, for plant, motor and bus.
        assumed: entries of a vehicle file and of gains, for the controller.
        settings: of the run beside plant and parameters.
    """
    true, of_car = loop_parameters(car, plant), controller_parameters(car, plant)
    others = {name: value for name, value in true.items() if name not in of_car}
    parameters = others | controller_parameters(assumed, plant)
    course = for_car(MANOEUVRES[manoeuvre], given_torque(parameters))
    metrics = evaluate(simulate(course, settings_of(settings, plant=plant, parameters=parameters, seed=1)), course)
    return metrics.settling_time, metrics.overshoot


def softened(car: Mapping[str, Any], before: Mapping[str, Any], settings: Settings | None = None) -> Weights:
    """Weights of a design with which the car swings over less than before on both plants, in the mean over
    REDESIGN_MANOEUVRES. A lower washout does that; its price is torque that is withheld for longer.

    Args:
        car: entries of the vehicle file of the car as it is known now.
        before: entries of what its controller assumed until now.
        settings: of the runs beside plant and parameters.

    Raises:
        DesignError: there is no controller for this car.
    """
    bearable = MARGIN * _overshoots(car, before, settings)
    weights = WEIGHTS
    while np.any(_overshoots(car, {**car, **design(car, weights)}, settings) > bearable):
        if weights.washout * SOFTER < WEIGHTS.washout * SOFTEST:
            break
        weights = replace(weights, washout=SOFTER * weights.washout)
    return weights


def _overshoots(car: Mapping[str, Any], assumed: Mapping[str, Any], settings: Settings | None) -> np.ndarray:
    """Of each plant."""
    overshoots = [[worth(plant, name, car, assumed, settings)[1] for plant in PLANTS] for name in REDESIGN_MANOEUVRES]
    return np.mean(overshoots, axis=0)
