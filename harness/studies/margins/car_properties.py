"""What comes of the numbers of a car: how its drive train swings, how wide its gap is, what its controller can do."""

from collections.abc import Mapping
from dataclasses import replace
from math import degrees
from typing import Any, NamedTuple

from ....fmus.building.car_entries import car
from ....fmus.building.oscillation import SPEED, oscillation
from ....fmus.catalogue import EVERY
from ....models.damping_controller import BLOCK
from ...design.design_trials import loop_parameters
from ...loop.places import PLANTS
from .linear_loop import linear_loop
from .loop_analysis import point_of
from .modes import Mode, is_stable, modes
from .operating_point import Point

ABOUT = (0.5, 2.0)
"""Frequencies of a damped drive train, over the one without damping, between which its mode is looked for."""


class PlantProperties(NamedTuple):
    """The drive train of a plant at 15 km/h; frequencies in Hz.

    Attributes:
        damped: with control; None: there is no controller, or the loop with it is not stable.
    """

    plant: str
    frequency: float
    damping_ratio: float
    damped: Mode | None


class CarProperties(NamedTuple):
    """Attributes:
    gap: backlash at the wheel, from flank to flank, in degrees.
    wheel_torque: of all of the motor, in N.m.
    acceleration: in m/s2, of the car by that.
    taken, added: the most that the control takes from and adds to the demand, in N.m, and T_max with it.
    """

    plants: tuple[PlantProperties, ...]
    gap: float
    wheel_torque: float
    acceleration: float
    taken: float
    added: float
    T_max: float


def car_properties(entries: Mapping[str, Any], gains: Mapping[str, Any] | None) -> CarProperties:
    """
    Args:
        entries: of the vehicle file.
        gains: parameters of our controller; None: there is none.

    Raises:
        ParameterFileError: there is no such car.
    """
    full = car(entries)
    limits = {name: gains[name] for name in ("T_take_max", "T_add_max") if gains and name in gains}
    controller = BLOCK.Parameters(**limits)
    wheel_torque = full["T_max"] * full["i"]
    return CarProperties(
        plants=tuple(_of_plant(plant, entries, gains) for plant in PLANTS),
        gap=degrees(2.0 * full["phi_B"] / full["i"]),
        wheel_torque=wheel_torque,
        acceleration=wheel_torque / full["r"] / full["m"],
        taken=controller.T_take_max,
        added=controller.T_add_max,
        T_max=full["T_max"],
    )


def _of_plant(plant: str, entries: Mapping[str, Any], gains: Mapping[str, Any] | None) -> PlantProperties:
    block: Any = EVERY[plant].block
    point = replace(point_of(plant, BLOCK.name, loop_parameters({**entries, **(gains or {})}, plant)), v=SPEED)
    alone = oscillation(block, point.of("plant", block))
    return PlantProperties(plant, *alone, _damped(point, alone.frequency) if gains else None)


def _damped(point: Point, alone: float) -> Mode | None:
    """The drive train with control, which swings at about the frequency (Hz) that it has alone; without a mode there it
    does not swing."""
    loop = linear_loop(point)
    if not is_stable(loop):
        return None
    low, high = (factor * alone for factor in ABOUT)
    about = [mode for mode in modes(loop.mean) if low < mode.frequency < high]
    return min(about, key=lambda mode: mode.damping_ratio, default=Mode(alone, 1.0))
