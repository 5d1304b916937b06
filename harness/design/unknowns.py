"""What a vehicle file does not have of what decides how good the damping is, and what each is worth: how much worse a
car is damped that has half or twice of it, by a controller that does not know, than by one that does."""

from collections.abc import Mapping
from math import inf, isnan
from pathlib import Path
from typing import Any, NamedTuple

from toolground.plain_text import printed

from ...fmus.building.car_entries import Entry, car_entries
from ...fmus.building.estimates import DECIDE
from ...fmus.building.one_car import told_by_others, with_estimates
from ...fmus.building.parameter_files import read_vehicle
from ..loop.built_fmus import built
from ..loop.places import PLANTS
from ..loop.settings import Settings
from .design import design
from .kalman import DesignError
from .redesign import worth

OFF = (0.5, 2.0)
"""What a car may have of it, over what the vehicle file makes of it: scaling laws are off by so much."""

MANOEUVRE, PLANT = "tipin15", PLANTS[0]
"""In which it is measured."""

COSTS = f"what half or twice of it costs in settling and overshoot ({MANOEUVRE}, {PLANT})"
"""What the numbers are."""


class Unknown(NamedTuple):
    """
    Attributes:
        entry: with its value, and whether it is estimated or that of the default car.
        settling: by so many s the car may settle later; infinite: it does not settle.
        overshoot: by so much more (1) it may swing over.
    """

    entry: Entry
    settling: float
    overshoot: float

    @property
    def cells(self) -> tuple[str, str]:
        """Both, in ms and %."""
        time = "never" if self.settling == inf else f"{1e3 * self.settling:.0f}"
        return time, f"{100.0 * self.overshoot:.0f}"


def not_given(entries: Mapping[str, Any]) -> list[Entry]:
    """What of DECIDE no entry of a vehicle file tells."""
    lacking = {*DECIDE} - told_by_others(entries) - entries.keys()
    return [entry for entry in car_entries(entries) if entry.name in lacking]


def unknowns(entries: Mapping[str, Any]) -> list[Unknown]:
    """What of DECIDE a vehicle file does not have, with what each is worth; most of it first.

    Raises:
        DesignError: there is no controller for this car.
    """
    if not (lacking := not_given(entries)):
        return []
    car, settings = with_estimates(entries), built(PLANT)
    assumed = {**car, **design(car)}
    unknown_entries = [Unknown(entry, *_worth(car, entry, assumed, settings)) for entry in lacking]
    return sorted(unknown_entries, key=lambda unknown: (unknown.settling, unknown.overshoot), reverse=True)


def _worth(car: Mapping[str, Any], entry: Entry, assumed: Mapping[str, Any], settings: Settings) -> tuple[float, float]:
    """Settling time in s and overshoot (1) that are lost at most."""
    lost = (0.0, 0.0)
    for factor in OFF:
        true = {**car, entry.name: factor * entry.value}
        try:
            known = {**true, **design(true)}
        except DesignError:  # such a car has no controller at all
            continue
        (late, over), (soon, little) = (worth(PLANT, MANOEUVRE, true, of, settings) for of in (assumed, known))
        later = inf if isnan(late) else late - soon
        lost = max(lost[0], later), max(lost[1], over - little)
    return lost


def unknowns_line(vehicle: Path | None) -> str:
    """What a vehicle file does not have, and what it is worth, in one line; "" where there is none, or it has all."""
    try:
        of_car = unknowns(read_vehicle(vehicle)) if vehicle else []
    except DesignError as reason:
        return f"no gains can be designed for {vehicle}: {reason}"
    texts = (
        f"{of.entry.name} = {of.entry.value:.3g} {printed(of.entry.unit)} ({of.entry.origin}) "
        f"{of.cells[0]} ms, {of.cells[1]} %"
        for of in of_car
    )
    return f"not in {vehicle.name}, and {COSTS}: {'; '.join(texts)}" if vehicle and of_car else ""
