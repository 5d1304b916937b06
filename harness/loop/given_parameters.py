"""Settings with the parameters that a user gives: files of car and controller, and values by name."""

import dataclasses
from collections.abc import Collection, Iterable, Mapping
from pathlib import Path

from fmuloop.errors import WiringError
from fmuloop.interface import Interface, unit_of
from fmuloop.parameter_changes import parted
from fmuloop.system import System
from fmuloop.wiring import find, fit, out_of_bounds, require
from toolground.collected_warnings import warn_once
from toolground.errors import UserError
from toolground.unit_conversion import factor

from .built_fmus import built_together
from .parameter_words import said
from .places import PLANTS, ROAD_LOAD
from .settings import Settings, loop, own_frequency


class NotTaken(UserError):
    """A file of parameters names some that a controller does not have."""


def built_with(
    given: Iterable[Settings], vehicle: Path | None, parameters: Path | None, assigned: Mapping[str, float]
) -> list[Settings]:
    """What `built` makes of each of several settings that are given the same folder, as `with_parameters` has them. The
    errors are those of both."""
    given = list(given)
    for each in given:
        require_of_plant(assigned, str(each.plant))
    return [with_parameters(each, vehicle, parameters, assigned) for each in built_together(given, alike=False)]


def with_parameters(
    made: Settings,
    vehicle: Path | None,
    parameters: Path | None,
    assigned: Mapping[str, float],
    one_of_several: bool = False,
) -> Settings:
    """Settings, whose FMUs are there, with what the files name, for every instance that has it, and with the values of
    `instance.parameter`, which go before.

    Args:
        one_of_several: the controller is; values of parameters that it does not have are left out.

    Raises:
        WiringError: the FMUs do not have a parameter, or not with that value or in that unit.
        ParameterFileError: a file is refused.
        NotTaken: the controller does not have all that its file names.
    """
    system = loop(made)
    values, car, frequency = _of_files(system, vehicle, parameters) if vehicle or parameters else ({}, {}, None)
    if one_of_several:
        known = fit(system).interfaces
        lacking = [n for n in assigned if n.startswith("controller.") and not find(parted(n)[0], "parameter", known)[0]]
        assigned = {name: value for name, value in assigned.items() if name not in lacking}
    made = dataclasses.replace(made, parameters=values | dict(assigned), road_load=car, frequency=frequency)
    require(out_of_bounds(fit(system, parameters=made.parameters), made.parameters))
    return made


def require_of_plant(names: Collection[str], plant: str) -> None:
    """Refuses parameters that a plant of the project lacks and another one has.

    Raises:
        WiringError: names them, and that plant.
    """
    if not (names and plant in PLANTS):
        return
    from ...fmus.catalogue import FMUS  # all equations, which a run of FMUs does not need

    problems = []
    for name in names:
        place, _, parameter = name.partition("@")[0].partition(".")
        having = [other for other in PLANTS if parameter in FMUS[other].block.Parameters._fields]
        if place == "plant" and having and plant not in having:
            others = f"--plant {' or '.join(having)}"
            problems.append(said("elsewhere", name=name, plant=plant, parameter=parameter, others=others))
    if problems:
        raise WiringError("\n".join(problems))


def _of_files(
    system: System, vehicle: Path | None, parameters: Path | None
) -> tuple[dict[str, float], dict[str, float], float | None]:
    """The parameters `instance.name` that the FMUs have; by name what the plant of somebody else does not tell of its
    car: what the file of the vehicle has, else what the default car has; and the frequency of the car of a file, Hz."""
    from ...fmus.building.one_car import of_one_car
    from ...fmus.building.parameter_files import for_instances, of_plants, read_files, require_taken, units
    from ...fmus.catalogue import FMUS
    from ...fmus.errors import ParameterFileError

    interfaces = fit(system).interfaces
    names = {
        instance: {variable.name for variable in interface.of_causality("parameter")}
        for instance, interface in interfaces.items()
    }
    every = set().union(*names.values())
    values = of_one_car(read_files(vehicle, parameters, others=every), every)
    try:
        require_taken(parameters, every, system.instances["controller"].name)
    except ParameterFileError as refusal:
        raise NotTaken(str(refusal)) from refusal
    meant = {name: unit for name, unit in units().items() if name in values}
    plant = system.instances["plant"]
    car: dict[str, float] = {}
    usual = FMUS[PLANTS[0]].block.Parameters._field_defaults
    if "plant" not in system.own and vehicle is not None:
        if lacking := sorted(of_plants() & values.keys() - names["plant"]):
            taken, lacks = ", ".join(sorted(values.keys() & names["plant"])), ", ".join(lacking)
            if taken:
                own = f"it takes {taken}, and the rest stays its own: it may be another car than that of the file"
            else:
                own = "the file reaches the other blocks alone"
            warn_once(f"{plant} has no parameter {lacks}: {own}")
        car = {name: values.get(name, usual[name]) for name in ROAD_LOAD if name not in names["plant"]}
    require(
        problem
        for instance, interface in interfaces.items()
        for name in sorted(names[instance] & meant.keys())
        if (problem := _other_unit(interface, f"{instance}.{name}", meant[name], system.mapping))
    )
    return for_instances(values, names), car, own_frequency({**usual, **values}) if vehicle else None


def _other_unit(interface: Interface, name: str, meant: str, mapping: Mapping[str, str]) -> str | None:
    """Why the number of a file, in the unit that is meant, does not reach the parameter `instance.name`, or None."""
    theirs = mapping.get(name, name.partition(".")[2])
    unit = next(unit_of(variable) for variable in interface.description.modelVariables if variable.name == theirs)
    if unit in (None, "", meant):
        return None
    try:
        other = factor(unit, meant)
    except ValueError as reason:
        return f"{name} {reason}, the unit of the file"
    if name in mapping or other == 1.0:
        return None
    return f"{name} is in {unit}; the file gives it in {meant} (--map {name}={theirs} converts it)"
