"""The manoeuvres of the catalogue for a car: their demands are shares of what its motor can do."""

from collections.abc import Mapping
from dataclasses import replace
from math import inf, isinf

from ...fmus.names import T_MAX
from ..loop import roles
from .manoeuvre import Manoeuvre
from .signals import FlatSine, Held, Lines, Signal


def given_torque(parameters: Mapping[str, float]) -> float:
    """Largest torque of the motor in N.m among parameters of a loop; inf: it is not among them."""
    return parameters.get(roles.LARGEST_TORQUE, inf)


def share_of(T_max: float) -> float:
    """A largest torque over that of the default car, for which the catalogue is written; 1 for inf."""
    return 1.0 if isinf(T_max) else T_max / T_MAX


def for_car(manoeuvre: Manoeuvre, T_max: float) -> Manoeuvre:
    """A manoeuvre of the catalogue with its demand in proportion to the largest torque of the motor; the same one where
    that is the default car's.

    Args:
        T_max: in N.m; inf where it is not known, which leaves the manoeuvre as it is.
    """
    share = share_of(T_max)
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
