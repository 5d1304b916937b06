"""What comes of the numbers of a car: how its drive train swings, how wide its gap is, what its controller can do."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from math import degrees
from typing import Any, NamedTuple

from rich.box import SIMPLE_HEAD
from rich.table import Table

from ....fmus.building.car_entries import Entry, car
from ....fmus.building.oscillation import SPEED, oscillation
from ....fmus.catalogue import EVERY
from ....models.damping_controller import BLOCK
from ...design.design_trials import loop_parameters
from ...loop.places import PLANTS
from ...views.terminal import plain_table, print_table
from .linear_loop import linear_loop
from .loop_analysis import point_of
from .modes import Mode, is_stable, modes
from .operating_point import Point

SHORT = {
    "TwoMassDriveline": "design plant",
    "ValidationVehicle": "vehicle",
    "MotorTorqueLoop": "motor",
    "WheelSpeedCan": "bus",
    "DampingController": "controller",
}
"""What stands in the table for the name of an FMU."""

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


def announce(entries: Iterable[Entry], found: CarProperties, title: str, gains: str) -> None:
    """Prints the entries of a car, and what comes of them with gains of some origin."""
    table = Table(title=title, title_justify="left", box=SIMPLE_HEAD, padding=0)
    for heading in ("entry", "value", "unit", "from", "taken by", "meaning"):
        table.add_column(heading, justify="right" if heading == "value" else "left", no_wrap=heading != "meaning")
    before = None
    for entry in entries:
        if before not in (None, entry.origin):
            table.add_section()
        before = entry.origin
        origin = f"{entry.origin} ({entry.source})" if entry.source else entry.origin
        value = str(entry.value).lower() if isinstance(entry.value, bool) else f"{entry.value:.6g}"
        blocks = ", ".join(SHORT.get(name, name) for name in entry.blocks)
        table.add_row(entry.name, value, entry.unit, origin, blocks, entry.meaning)
    print_table(table)

    headings = ["drive train at 15 km/h", "frequency\nHz", "damping\nratio", "with control\nHz", "damping\nratio"]
    rows = []
    for plant in found.plants:
        damped = [f"{plant.damped.frequency:.2f}", f"{plant.damped.damping_ratio:.2f}"] if plant.damped else ["-", "-"]
        rows.append([plant.plant, f"{plant.frequency:.2f}", f"{plant.damping_ratio:.3f}", *damped])
    print_table(plain_table(f"control: {gains}; - where there is none, or the loop is not stable", headings, rows))
    print(
        f"backlash at the wheel: {found.gap:.2f} degrees from flank to flank\n"
        f"authority: the control takes up to {found.taken:g} N.m from the demand and adds up to {found.added:g} N.m, "
        f"of T_max = {found.T_max:g} N.m\n"
        f"at the wheels: {found.wheel_torque:.4g} N.m by all of the motor, which is {found.acceleration:.2f} m/s2"
    )
