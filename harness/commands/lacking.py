"""What a vehicle file does not have, for the commands that work with it all the same."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ..design.unknowns import Unknown


def lacking(entries: Mapping[str, Any]) -> "Sequence[Unknown]":
    """What the entries of a vehicle file do not tell of what decides, with what each is worth."""
    from ..design.unknowns import PLANT, not_given, unknowns
    from ..loop.built_fmus import built

    return unknowns(entries, built(PLANT)) if not_given(entries) else ()


def lacking_line(vehicle: Path | None) -> str:
    """The same in one line; "" if there is nothing to say.

    Raises:
        DesignError: there is no controller for this car.
    """
    from ...fmus.building.parameter_files import read_vehicle
    from ..design.unknowns import told

    return told(lacking(read_vehicle(vehicle)), vehicle.name) if vehicle else ""
