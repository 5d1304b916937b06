"""Tunable parameters that a run changes: `instance.parameter@t` is one from the time t in s on."""

from collections.abc import Mapping
from math import ceil, isnan
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolground.plain_text import quoted
from toolground.written_numbers import real

from .errors import WiringError
from .parameter_words import said

LATE = 1e-6
"""Share of a step by which an instant may be late and still be that of a change."""


class Change(NamedTuple):
    """Before the step of that number a parameter is set."""

    step: int
    instance: str
    parameter: str
    value: float


def parted(name: str) -> tuple[str, float | None]:
    """`instance.parameter` and the time in s from which on it has a value; None: it has it from the start on.

    Raises:
        WiringError: what stands behind the @ is no time. In a quoted name of FMI the @ is part of it.
    """
    if "@" not in name or "'" in name:
        return name, None
    parameter, _, time = (part.strip() for part in name.partition("@"))
    instant = real(time)
    if instant is None or isnan(instant):
        raise WiringError(said("time", name=name, time=quoted(time)))
    return parameter, instant


def initial(parameters: Mapping[str, float]) -> dict[str, float]:
    """Those that are set before the start."""
    return {name: value for name, value in parameters.items() if parted(name)[1] is None}


def changes(parameters: Mapping[str, float], time: NDArray[np.float64]) -> list[Change]:
    """What is changed at the instants of a run, in their order: each before the first step that begins at its time.

    Raises:
        WiringError: no step begins then or later, or one parameter is set twice there.
    """
    ordered: list[Change] = []
    size, last = float(time[1]), float(time[-2])
    for name, value in parameters.items():
        parameter, instant = parted(name)
        if instant is None:
            continue
        if not 0.0 <= instant <= last + LATE * size:
            raise WiringError(said("late", name=name, last=last))
        instance, _, own = parameter.partition(".")
        change = Change(ceil(instant / size - LATE), instance, own, value)
        if any(other[:3] == change[:3] for other in ordered):
            raise WiringError(said("same_step", name=name, parameter=parameter))
        ordered.append(change)
    return sorted(ordered, key=lambda change: change.step)


def require_constant(parameters: Mapping[str, float], what: str) -> None:
    """Refuses changes where there is no run that could make them.

    Raises:
        WiringError: names the first.
    """
    for name in parameters:
        if parted(name)[1] is not None:
            raise WiringError(f"{name}: the parameters of {what} have one value from the start on")
