"""For which blocks a mapping is, and whether what it names is something of the loop."""

from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from pathlib import Path

from fmuloop.errors import WiringError
from fmuloop.limits import Limits
from toolground.known_names import meant, nearest

from .places import CONNECTIONS, INPUTS, OFFERED, OUTPUTS, PARAMETERS, PLACES, block_and_variable


def mappings(
    mapping: Mapping[str, str], plants: Sequence[str], controllers: Sequence[str], limits: Limits
) -> dict[tuple[str, str], dict[str, str]]:
    """What of a mapping is for each plant with each controller: of several FMUs of somebody else in a place, an entry
    is for those that have the variable, and one of a table that is named as an FMU's file for that FMU alone; blocks
    of the project beside them get none.

    Args:
        plants, controllers: names of blocks, or paths of FMUs.
    """
    places = {"plant": plants, "controller": controllers}
    own = {place: _entries(mapping, place, blocks, limits) for place, blocks in places.items()}
    files = {Path(block).stem for blocks in places.values() for block in blocks}

    def others(*blocks: str) -> dict[str, str]:
        named = {*places, *files} - {Path(block).stem for block in blocks}
        known = {*places, *files}
        return {name: its for name, its in mapping.items() if block_and_variable(name, known)[0] not in named}

    return {(p, c): others(p, c) | own["plant"][p] | own["controller"][c] for p in plants for c in controllers}


def _entries(
    mapping: Mapping[str, str], place: str, blocks: Iterable[str], limits: Limits
) -> dict[str, dict[str, str]]:
    """For each block in a place its entries; one that none of several has is for all, to be refused."""
    from fmuloop.interface import Interface  # who asks for help alone needs no fmpy

    entries = {name: theirs for name, theirs in mapping.items() if name.partition(".")[0] == place}
    foreign = [block for block in blocks if block not in PLACES[place]]
    several = entries and len(foreign) > 1
    has = {block: Interface(Path(block), limits).variables for block in foreign} if several else {}
    none_has = {theirs for theirs in entries.values() if not any(theirs in each for each in has.values())}

    def taken(block: str) -> dict[str, str]:
        if foreign and block not in foreign:
            return {}
        return {name: theirs for name, theirs in entries.items() if theirs in none_has or theirs in has[block]}

    return {block: taken(block) for block in blocks}


def require_known(mapping: Mapping[str, str]) -> None:
    """Refuses what maps a name that no block in that place has.

    Raises:
        WiringError: names it, and what is near, else what the loop exchanges with the place.
    """
    problems = dict[str, None]()
    for name, theirs in mapping.items():
        place, _, variable = name.partition(".")
        if place not in PLACES:
            problems[f"{place} is no place of the loop, nor the name of an FMU in it; {nearest(place, PLACES)}"] = None
        elif variable not in (known := known_variables(place)):
            ports = (port for each in (CONNECTIONS, OFFERED) for connection in each for port in connection[:2])
            ports = [*ports, *(port.name for each in (INPUTS, PARAMETERS, OUTPUTS) for port in each)]
            there = dict.fromkeys(port.partition(".")[2] for port in ports if port.startswith(f"{place}."))
            near = meant(variable, known) or f"known are {', '.join(there)}, and the parameters of our blocks"
            problems[f"{name}={theirs}: nothing in the loop is called {name}; {near}"] = None
    if problems:
        raise WiringError("\n".join(problems))


@lru_cache
def known_variables(place: str) -> frozenset[str]:
    """Names of the variables that the project's blocks for a place have."""
    from fmublocks.description.variables import interface

    from ...fmus.catalogue import EVERY  # all equations, which a run without a mapping does not need

    return frozenset(variable.name for name in PLACES[place] for variable in interface(EVERY[name].block))
