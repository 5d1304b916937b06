"""What comes of the numbers of a car: how its drive train swings, how wide its gap is, what its controller can do."""

from collections.abc import Mapping, Sequence
from itertools import zip_longest
from math import degrees
from typing import Any, NamedTuple

from rich.box import SIMPLE_HEAD
from rich.table import Table

from toolground.plain_text import printed
from toolground.tables import plain_table, print_table

from ....fmus.building.car_entries import Entry, car
from ....fmus.building.estimates import DECIDE, SHEET
from ....fmus.building.one_car import MEASURED
from ....models.damping_controller import BLOCK
from ...design.loop_parameters import loop_parameters
from ...design.unknowns import COSTS, Unknown
from ...loop.places import PLANTS
from .linear_loop import linear_loop
from .loop_analysis import point_of
from .modes import MEANT, Mode, alone, drive_train_mode, is_stable

SHORT = {
    "TwoMassDriveline": "design plant",
    "ValidationVehicle": "vehicle",
    "MotorTorqueLoop": "motor",
    "WheelSpeedCan": "bus",
    "DampingController": "controller",
}
"""What stands in the table for the name of an FMU."""


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
        plants=tuple(swing(plant, entries, gains) for plant in PLANTS),
        gap=degrees(2.0 * full["phi_B"] / full["i"]),
        wheel_torque=wheel_torque,
        acceleration=wheel_torque / full["r"] / full["m"],
        taken=controller.T_take_max,
        added=controller.T_add_max,
        T_max=full["T_max"],
    )


def swing(plant: str, entries: Mapping[str, Any], gains: Mapping[str, Any] | None) -> PlantProperties:
    """The drive train of a car in a plant without control, and with that of some gains; as of `car_properties`."""
    point = point_of(plant, BLOCK.name, loop_parameters({**entries, **(gains or {})}, plant))
    usual, loop = alone(point), linear_loop(point) if gains else None
    damped = drive_train_mode(loop, usual.frequency) if loop and is_stable(loop) else None
    return PlantProperties(plant, *usual, damped)


def announce(
    entries: Sequence[Entry], found: CarProperties, unknown: Sequence[Unknown], title: str, gains: str, every: bool
) -> None:
    """Prints the entries of a car, all or those that decide, and what comes of them with gains of some origin."""
    worth = {each.entry.name: each.cells for each in unknown}
    shown = [each for each in entries if every or each.name in {*MEASURED, *SHEET, *DECIDE}]
    headings = ["entry", "value", "unit", "from", "taken by" if every else "ms", "meaning" if every else "%"]
    if not every:
        headings.insert(4, "meaning")
    table = Table(title=title, title_justify="left", box=SIMPLE_HEAD, padding=(0, 1, 0, 0))
    for heading in headings:
        table.add_column(
            heading, justify="right" if heading in ("value", "ms", "%") else "left", no_wrap=heading != "meaning"
        )
    for each, after in zip_longest(shown, shown[1:]):
        origin = f"{each.origin} ({each.source})" if each.source else each.origin
        number, unit = (degrees(each.value), "deg") if each.name == "gap" else (each.value, each.unit)
        value = str(number).lower() if isinstance(number, bool) else f"{number:.6g}"
        blocks = ", ".join(SHORT.get(name, name) for name in each.blocks)
        rest = (blocks, each.meaning) if every else (each.meaning, *worth.get(each.name, ("", "")))
        table.add_row(
            each.name, value, printed(unit), origin, *rest, end_section=bool(after and after.origin != each.origin)
        )
    print_table(table)
    if not every:
        print(*([f"ms, %: {COSTS}"] if unknown else []), f"{len(entries) - len(shown)} other entries: --all", sep="\n")

    headings = ["drive train at 15 km/h", "frequency\nHz", "damping\nratio", "with control\nHz", "damping\nratio"]
    rows = []
    for plant in found.plants:
        swings = plant.damped and plant.damped.damping_ratio < 1.0
        damped = (
            [f"{plant.damped.frequency:.2f}" if swings else "-", f"{plant.damped.damping_ratio:.2f}"]
            if plant.damped
            else ["-", "-"]
        )
        rows.append([plant.plant, f"{plant.frequency:.2f}", f"{plant.damping_ratio:.3f}", *damped])
    print_table(plain_table(f"control: {gains}; - where there is none, or no swing, or no stable loop", headings, rows))
    print(
        f"with control: {MEANT}\n"
        f"backlash at the wheel: {found.gap:.2f} degrees from flank to flank\n"
        f"authority: the control takes up to {found.taken:.3g} N·m from the demand and adds up to {found.added:.3g}, "
        f"of T_max = {found.T_max:g} N·m\n"
        f"at the wheels: {found.wheel_torque:.0f} N·m by all of the motor, which is {found.acceleration:.2f} m/s²"
    )
