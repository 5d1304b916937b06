"""Entries of parameter files as parameters of a loop."""

from collections.abc import Mapping
from typing import Any

from ...fmus.building.builds import fmu_of
from ...fmus.building.parameter_files import for_instances
from ..loop.places import PLACES


def loop_records(plant: str, controller: str = PLACES["controller"][0]) -> dict[str, Any]:
    """The declared parameters of the blocks of a loop, by their places, with a plant and a controller of ours."""
    blocks = {place: names[0] for place, names in PLACES.items()} | {"plant": plant, "controller": controller}
    return {place: fmu_of(name).block.Parameters for place, name in blocks.items()}


def loop_parameters(values: Mapping[str, Any], plant: str, controller: str = PLACES["controller"][0]) -> dict[str, Any]:
    """Entries of parameter files as parameters of the loop with a plant and a controller of ours.

        van = driveline.read_files(Path("van.toml"), Path("van_gains.toml"))
        driveline.simulate(tipin, "ValidationVehicle", parameters=driveline.loop_parameters(van, "ValidationVehicle"))

    Returns:
        `instance.name` -> value, for every block that has the name.
    """
    records = loop_records(plant, controller)
    return for_instances(values, {place: record._fields for place, record in records.items()})


def controller_parameters(values: Mapping[str, Any], plant: str) -> dict[str, Any]:
    """Of `loop_parameters` those of the controller alone: what it assumes, whatever the car is."""
    return {name: value for name, value in loop_parameters(values, plant).items() if name.startswith("controller.")}
