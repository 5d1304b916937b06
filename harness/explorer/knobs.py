"""What can be turned: parameters by the names of parameter files, with the limits that the FMUs declare."""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from fmuloop.interface import unit_of
from fmuloop.wiring import Fit

from ..design.character import factors

CAR = ("phi_B", "C", "m", "J_1", "J_2", "c_slip", "tau", "d_max")
"""Of the car: each is one for all blocks that have it, and others follow from it as from a vehicle file. d_max is the
longest delay of the wheel speed on the bus."""

GAINS = ("k_d", "omega_w", "shape_1", "shape_2", "k_gap", "T_gap", "landing_share", "demand_lead", "t_return")
"""Of the controller."""

ROAD = ("mu",)
"""Of the road, where the plant has it."""

FAR = 5.0
"""A slider goes to so many times the value at the start, and down to this part of it, within what FMUs declare; further
values can be typed. One below 0 goes up to 0."""

NEAR = {"C": 2.0, "c_slip": 2.0}
"""The same where half shafts would follow that are stiffer than any."""

SPORT, COMFORT = (factors(end) for end in (0.0, 1.0))
"""Factors on gains at both ends of the character; docs/explorer.md says what they do."""


class Knob(NamedTuple):
    """A parameter.

    Attributes:
        low, high: ends of its slider.
        least, most: what can be typed.
        value: at the start.
        unit: "" for none.
        meaning: as the FMU declares it.
    """

    name: str
    low: float
    high: float
    least: float
    most: float
    value: float
    unit: str
    meaning: str


def knobs(names: Sequence[str], fits: Sequence[Fit], values: Mapping[str, float]) -> Iterator[Knob]:
    """Those of the names that some instance has.

    Args:
        fits: of the loops that can be chosen.
        given: `instance.name` -> value, where it is not the start value that the FMU declares.
    """
    for name in names:
        owners = [
            (f"{instance}.{name}", interface.variables[name])
            for fit in fits
            for instance, interface in fit.interfaces.items()
            if name in interface.variables and interface.variables[name].causality == "parameter"
        ]
        if not owners:
            continue
        key, variable = owners[0]
        value = float(values.get(key, variable.start or 0.0))
        least = max(float(variable.min) for _, variable in owners if variable.min is not None)
        most = min(float(variable.max) for _, variable in owners if variable.max is not None)
        far = NEAR.get(name, FAR)
        low = max(least, value / far) if least > 0.0 else max(least, min(far * value, 0.0))
        unit = unit_of(variable) or ""
        high = min(most, far * value if value > 0.0 else most if value == 0.0 else 0.0)
        yield Knob(name, low, high, least, most, value, "" if unit == "1" else unit, str(variable.description))
