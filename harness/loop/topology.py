"""How many drive units a loop has: a motor, a controller and a bus each, on the one body of the plant.

    [units.front]  # what the plant calls the signals of the unit, where that is not as in a loop of one
    T_mot = "T_mot_front"
    omega_1 = "omega_1_front"

    [units.rear]
    T_mot = "T_mot_rear"
    omega_1 = "omega_1_rear"

The blocks of the units are called controller_front, motor_front, can_front, ...; what no unit has of its own, as the
brake or the speed of the body, all have in common. A run is read as one of its units sees it, see
`harness.loop.unit_runs`.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from fmuloop.errors import WiringError
from fmuloop.system import Connection, Port
from toolground.plain_text import plain
from toolground.toml_file import toml_entries

from .places import CONNECTIONS, INPUTS, OFFERED, OPTIONAL, OUTPUTS, PARAMETERS, PLACES, TRUTH

BODY = "plant"
"""The place of the one block that all drive units share."""


class DriveUnit(NamedTuple):
    """A motor with its controller and its bus.

    Attributes:
        name: "" where it is the only one.
        of_plant: what the plant calls its signals, by what they are called in a loop of one drive unit.
    """

    name: str = ""
    of_plant: tuple[tuple[str, str], ...] = ()

    def instance(self, place: str) -> str:
        """What its block in a place is called."""
        return f"{place}_{self.name}" if self.name and place != BODY else place

    def named(self, plant: str) -> str:
        """Its name in tables, after that of the plant."""
        return f"{plant} {self.name}".rstrip()

    def own(self, name: str) -> str:
        """What a signal `place.variable` of a loop of one drive unit is for this one."""
        place, _, variable = name.partition(".")
        return f"{self.instance(place)}.{dict(self.of_plant).get(variable, variable) if place == BODY else variable}"


@dataclass(frozen=True)
class Topology:
    """The blocks of a loop and what is exchanged between them."""

    units: tuple[DriveUnit, ...] = (DriveUnit(),)

    @cached_property
    def places(self) -> dict[str, str]:
        """The place of each instance, in the order in which they step."""
        return {unit.instance(place): place for place in PLACES for unit in self.units}

    @cached_property
    def connections(self) -> tuple[Connection, ...]:
        """From outputs to inputs."""
        return self._connected(CONNECTIONS)

    @cached_property
    def offered(self) -> tuple[Connection, ...]:
        """Made where both FMUs have their end."""
        return self._connected(OFFERED)

    @cached_property
    def truth(self) -> tuple[Connection, ...]:
        """What the comparator TrueMotion gets beside."""
        return self._connected(TRUTH)

    @cached_property
    def inputs(self) -> tuple[Port, ...]:
        """What a run gives."""
        return self._ports(INPUTS)

    @cached_property
    def parameters(self) -> tuple[Port, ...]:
        """What every run sets."""
        return self._ports(PARAMETERS)

    @cached_property
    def outputs(self) -> tuple[Port, ...]:
        """What is evaluated after a run."""
        return self._ports(OUTPUTS)

    @cached_property
    def optional(self) -> dict[str, float | None]:
        """What an FMU may lack, and what it then stands for."""
        return {unit.own(name): value for unit in self.units for name, value in OPTIONAL.items()}

    def instances(self, place: str) -> list[str]:
        """The blocks in a place."""
        return [instance for instance, of in self.places.items() if of == place]

    def _connected(self, connections: Iterable[Connection]) -> tuple[Connection, ...]:
        each = (Connection(u.own(c.source), u.own(c.target), c.unit) for u in self.units for c in connections)
        return tuple(dict.fromkeys(each))

    def _ports(self, ports: Iterable[Port]) -> tuple[Port, ...]:
        return tuple(dict.fromkeys(port._replace(name=unit.own(port.name)) for unit in self.units for port in ports))


ONE_UNIT = Topology()


def read_topology(path: Path) -> Topology:
    """The topology of a file.

    Raises:
        WiringError: there is no such file, or it declares no drive units.
    """
    try:
        entries = toml_entries(path)
    except (OSError, ValueError) as error:
        raise WiringError(f"{path}: {plain(error)}") from error
    units = entries.get("units")
    if not isinstance(units, Mapping) or len(entries) > 1 or not all(map(_is_unit, units.items())):
        raise WiringError(f"{path}: it must have tables such as [units.front], with names of signals of the plant")
    return Topology(tuple(DriveUnit(name, tuple(of_plant.items())) for name, of_plant in units.items()))


def _is_unit(entry: tuple[str, object]) -> bool:
    name, of_plant = entry
    return (
        name.isidentifier()
        and isinstance(of_plant, Mapping)
        and all(isinstance(theirs, str) and theirs for theirs in of_plant.values())
    )
