"""Whether what a mapping names is something of the loop."""

from collections.abc import Mapping
from functools import lru_cache

from ...fmus.names import meant
from ..base.errors import WiringError
from .places import CONNECTIONS, INPUTS, OFFERED, OUTPUTS, PARAMETERS, PLACES


def require_known(mapping: Mapping[str, str]) -> None:
    """Refuses what maps a name that no block in that place has.

    Raises:
        WiringError: names it, and what is near, else what the loop exchanges with the place.
    """
    problems = []
    for name, theirs in mapping.items():
        place, _, variable = name.partition(".")
        if place in PLACES and variable not in (known := _known(place)):
            ports = (port for each in (CONNECTIONS, OFFERED) for connection in each for port in connection[:2])
            ports = [*ports, *(port.name for each in (INPUTS, PARAMETERS, OUTPUTS) for port in each)]
            there = dict.fromkeys(port.partition(".")[2] for port in ports if port.startswith(f"{place}."))
            near = meant(variable, known) or f"known are {', '.join(there)}, and the parameters of our blocks"
            problems.append(f"{name}={theirs}: nothing in the loop is called {name}; {near}")
    if problems:
        raise WiringError("\n".join(problems))


@lru_cache
def _known(place: str) -> frozenset[str]:
    """Names of the variables that the project's blocks for a place have."""
    from ...fmus.catalogue import EVERY  # all equations, which a run without a mapping does not need
    from ...fmus.description.variables import interface

    return frozenset(variable.name for name in PLACES[place] for variable in interface(EVERY[name].block))
