"""Whether a loop can be driven through a manoeuvre that somebody has written."""

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

import numpy as np

from fmuloop.experiment import instants, sampled
from fmuloop.wiring import Fit, beyond_bounds

from ..loop.places import STEP_SIZE
from ..loop.resolved import ResolvedLoop
from .manoeuvre import Manoeuvre
from .parts import ManoeuvreError


def require_possible(
    manoeuvres: Mapping[str, Manoeuvre], files: Mapping[str, Path], loops: Iterable[ResolvedLoop]
) -> None:
    """Refuses manoeuvres that the loops of the plants cannot be driven through; only those of files are not known to be
    within all bounds.

    Args:
        manoeuvres: by their names.
        files: of those that are files.

    Raises:
        ManoeuvreError: see `require_road` and `require_drivable`.
    """
    for resolved in loops:
        for manoeuvre in manoeuvres.values():
            require_road(manoeuvre, resolved.fit)
        for name, path in files.items():
            require_drivable(manoeuvres[name], resolved, str(path))


def require_drivable(manoeuvre: Manoeuvre, resolved: ResolvedLoop, label: str) -> None:
    """
    Args:
        label: what the manoeuvre is called.

    Raises:
        ManoeuvreError: names all that is beyond what an FMU takes, or the motor can make.
    """
    if problems := list(_problems(manoeuvre, resolved)):
        raise ManoeuvreError("\n".join(f"{label}: {problem}" for problem in problems))


def require_road(manoeuvre: Manoeuvre, fitted: Fit) -> None:
    """Refuses a plant that cannot have the road of a manoeuvre.

    Raises:
        ManoeuvreError: names the parameter that the plant lacks.
    """
    plant = fitted.interfaces["plant"]
    for name, value in manoeuvre.road.items():
        if name not in plant.variables:
            raise ManoeuvreError(
                f"{manoeuvre.name} is for plants with a parameter {name} ({value:g} there); {plant.path.name} has none"
            )


def _problems(manoeuvre: Manoeuvre, resolved: ResolvedLoop) -> Iterator[str]:
    time = instants(manoeuvre.duration, min(STEP_SIZE, manoeuvre.duration))
    for port in resolved.settings.topology.parameters:
        if hasattr(manoeuvre, port.variable):
            value = getattr(manoeuvre, port.variable)
            if problem := beyond_bounds(resolved.fit, "parameter", port.name, value):
                yield f"{port.variable} = {value:g} {port.unit}: {problem}"
    T_max = resolved.T_max
    for port in resolved.settings.topology.inputs:
        if hasattr(manoeuvre, port.variable):
            values = np.broadcast_to(sampled(port.name, getattr(manoeuvre, port.variable), time), time.shape)
            for k in (values.argmin(), values.argmax()):
                problem = beyond_bounds(resolved.fit, "input", port.name, values[k])
                if port.variable == "T_driver" and abs(values[k]) > T_max:
                    problem = f"the motor makes {-T_max:g} to {T_max:g} N.m (motor.T_max)"
                if problem:
                    yield f"{port.variable} = {values[k]:g} {port.unit} at {time[k]:g} s: {problem}"
                    break
