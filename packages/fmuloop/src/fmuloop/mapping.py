"""What the loop calls a variable, and what the FMU that somebody else wrote calls it.

`plant.T_gear=Shaft.tau` says that plant.T_gear is Shaft.tau of the FMU in the place of the plant. Whatever else the
FMU calls T_gear is hidden. Values of what the loop connects, and of what is mapped, are converted into the unit that
the loop declares for the name, or into that of the SI where it declares none; a variable without a unit is taken to be
in it already.
"""

from collections.abc import Iterable, Iterator, Mapping
from copy import copy
from pathlib import Path
from typing import Any, cast

from fmpy.model_description import ModelVariable

from toolground.collected_warnings import warn_once
from toolground.known_names import nearest
from toolground.plain_text import reason
from toolground.toml_file import toml_entries
from toolground.unit_conversion import SI, factor

from .errors import WiringError
from .interface import Interface, unit_of
from .system import System


def parsed(texts: Iterable[str]) -> dict[str, str]:
    """The mapping of a system from texts such as `plant.T_gear=Shaft.tau`, or the paths of files that have it.

    Raises:
        WiringError: a text is not of that form, or a name of the loop stands for two variables; see also `read`.
    """
    mapping: dict[str, str] = {}
    for text in texts:
        name, equals, theirs = (part.strip() for part in text.partition("="))
        if not equals and (name.endswith(".toml") or Path(name).is_file()):
            names = read(Path(name))
        elif theirs and all(name.partition(".")):
            names = {name: theirs}
        else:
            no_file = "" if equals else f", and there is no file {name}"
            raise WiringError(f"{text!r} is not of the form plant.T_gear=Shaft.tau{no_file}")
        for ours, own in names.items():
            if mapping.setdefault(ours, own) != own:
                raise WiringError(
                    f"{ours} cannot be both {mapping[ours]} and {own}; of two FMUs each can have a table of its own, "
                    "named as its file: [mine] for mine.fmu"
                )
    return mapping


def read(path: Path) -> dict[str, str]:
    """The mapping of a file: a table for each place of the loop, with its names and those of the FMU.

        [plant]
        T_gear = "Shaft.tau"

    Raises:
        WiringError: there is no such file, or it is no such mapping.
    """
    try:
        entries = toml_entries(path)
    except (OSError, ValueError) as error:
        raise WiringError(f"{path}: {reason(error)}") from error
    mapping: dict[str, str] = {}
    for place, names in entries.items():
        if not isinstance(names, dict):
            raise WiringError(f"{path}: {place} = {names!r:.40}; it must be a table such as [plant]")
        for name, theirs in cast(dict[str, Any], names).items():
            if not (isinstance(theirs, str) and theirs):
                raise WiringError(f"{path}: {place}.{name} = {theirs!r:.40}; it must be a name of the FMU in quotes")
            mapping[f"{place}.{name}"] = theirs
    return mapping


def apply(system: System, interfaces: Mapping[str, Interface]) -> Iterator[str]:
    """Gives the variables of the interfaces the names and units of the loop; yields what does not fit."""
    names: dict[str, dict[str, str]] = {instance: {} for instance in interfaces}
    for name, theirs in system.mapping.items():
        instance, _, ours = name.partition(".")
        if instance in names:
            names[instance][ours] = theirs
        else:
            yield f"{name}={theirs}: there is no instance {instance}; {nearest(instance, interfaces)}"
    units = {port.name: port.unit for ports in system.ports.values() for port in ports}
    for instance, interface in interfaces.items():
        own, mapped = interface.variables, names[instance]
        interface.variables = dict(_renamed(own, mapped))
        taken: dict[str, str] = {}
        for ours, theirs in mapped.items():
            problem = _missing_or_taken(theirs, ours, own, mapped)
            problem = problem or _convert(interface, ours, units.get(f"{instance}.{ours}", SI), taken)
            if problem:
                interface.refused.add(ours)
                yield f"{instance}.{ours}={theirs}: in {interface.path.name} {theirs} {problem}"
        for name, unit in units.items():
            of, _, ours = name.partition(".")
            connected = of == instance and ours in interface.variables and ours not in mapped
            if connected and (problem := _convert(interface, ours, unit, taken)):
                interface.refused.add(ours)
                yield f"{name} {problem} ({interface.path.name})"
        if taken:
            assumed = ", ".join(f"{ours} in {'that of the SI' if unit == SI else unit}" for ours, unit in taken.items())
            warn_once(f"{interface.path.name}: variables without a unit are taken to be in that of the loop: {assumed}")


def _renamed(own: Mapping[str, ModelVariable], names: Mapping[str, str]) -> Iterator[tuple[str, ModelVariable]]:
    for theirs, variable in own.items():
        mapped = [ours for ours, same in names.items() if same == theirs]
        for ours in mapped:
            renamed = copy(variable)
            renamed.name = ours
            yield ours, renamed
        if not mapped and theirs not in names:
            yield theirs, variable


def _missing_or_taken(theirs: str, ours: str, own: Mapping[str, ModelVariable], names: Mapping[str, str]) -> str | None:
    if theirs not in own:
        return f"does not exist; {nearest(theirs, own)}"
    others = [other for other, same in names.items() if same == theirs and other != ours]
    if others and own[theirs].causality != "output":
        return f"is mapped to {' and '.join(others)} too; only an output can be two things"
    return None


def _convert(interface: Interface, name: str, target_unit: str | None, taken: dict[str, str]) -> str | None:
    """Lets the values of a variable be converted into the wanted unit, if there is one; says what hinders it.

    Args:
        taken: gets the unit of a variable that has none.
    """
    variable = interface.variables[name]
    unit = unit_of(variable)
    if variable.type != "Real" or target_unit is None or unit == target_unit:
        return None
    try:
        if unit:
            interface.factors[name] = factor(unit, target_unit)
        else:
            taken[name] = target_unit
    except ValueError as reason:
        return str(reason)
    variable = interface.variables[name] = copy(variable)
    variable.unit = target_unit
    return None
