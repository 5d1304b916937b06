"""The manoeuvres of the catalogue for a car: their demands are shares of what its motor can do."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from .manoeuvre import Manoeuvre
from .signals import FlatSine, Held, Lines, Signal

T_MAX = 180.0
"""In N.m, of the default car, for which they are written."""


def for_car(manoeuvre: Manoeuvre, parameters: Mapping[str, Any]) -> Manoeuvre:
    """A manoeuvre of the catalogue with its demand in proportion to the largest torque of the motor; the same one where
    that is the default car's, or is not known.

    Args:
        parameters: `instance.name` -> value, of the loop that is driven.
    """
    share = float(parameters.get("motor.T_max", T_MAX)) / T_MAX
    if share == 1.0:
        return manoeuvre
    height = None if manoeuvre.dT is None else share * manoeuvre.dT
    return replace(manoeuvre, T_driver=_scaled(manoeuvre.T_driver, share), dT=height)


def _scaled(signal: Signal, by: float) -> Signal:
    match signal:
        case Lines() | Held():
            return replace(signal, values=[by * float(value) for value in signal.values])
        case FlatSine():
            return replace(signal, mean=by * signal.mean, amplitude=by * signal.amplitude)
        case _:
            return lambda t: by * signal(t)
