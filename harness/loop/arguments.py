"""What the settings of a run take from Python: a value of another kind gets one line that names it."""

from collections.abc import Callable, Mapping
from math import inf
from numbers import Integral, Real
from os import PathLike
from typing import Any

from fmuloop.errors import WiringError
from fmuloop.limits import Limits
from fmuloop.system import Scheme
from toolground.plain_text import plain

from .topology import Topology


def _block(value: Any) -> bool:
    return value is None or isinstance(value, str | PathLike)


def _number(value: Any) -> bool:
    """Whether it is a real number or a truth value, of numpy too, which help and mistakes are answered without."""
    return isinstance(value, Real) or type(value).__name__ in ("bool", "bool_")


def _texts(value: Any, of: type) -> bool:
    """Whether it maps texts to values of a type; None maps nothing."""
    return value is None or (
        isinstance(value, Mapping) and all(isinstance(k, str) and isinstance(v, of) for k, v in value.items())
    )


A_MANOEUVRE = "a Manoeuvre, such as MANOEUVRES['tipin15']"
BLOCKS = "names of blocks or paths of FMUs"
"""What several functions take."""

BLOCK = (_block, "the name of a block, or the path of an FMU")

ARGUMENTS: Mapping[str, tuple[Callable[[Any], bool], str]] = {
    "plant": BLOCK,
    "controller": BLOCK,
    "motor": BLOCK,
    "can": BLOCK,
    "control": (lambda value: _number(value) and value in (True, False), "True or False"),
    "parameters": (lambda value: _texts(value, object), "a dictionary such as {'plant.J_1': 0.06}"),
    "road_load": (lambda value: _texts(value, Real), "a dictionary such as {'m': 1450.0}"),
    "frequency": (
        lambda value: value is None or (isinstance(value, Real) and 0.0 < float(value) < inf),
        "a number of Hz above 0, or None",
    ),
    "step_size": (lambda value: isinstance(value, Real) and 0.0 < float(value) < inf, "a number of seconds above 0"),
    "scheme": (lambda value: isinstance(value, Scheme | str), "a Scheme or its name"),
    "seed": (lambda value: isinstance(value, Integral) and int(value) >= 0, "a whole number from 0 on"),
    "folder": (lambda value: isinstance(value, str | PathLike), "the path of a folder"),
    "build": (lambda value: value is None or isinstance(value, str), "'native', 'python' or None"),
    "mapping": (
        lambda value: isinstance(value, str | PathLike) or _texts(value, str),
        "a dictionary such as {'plant.T_gear': 'Shaft.tau'}, or the path of a file",
    ),
    "limits": (lambda value: isinstance(value, Limits), "Limits"),
    "topology": (
        lambda value: isinstance(value, Topology | str | PathLike),
        "a Topology, or the path of a file that declares one",
    ),
    "tolerance": (
        lambda value: value is None or (isinstance(value, Real) and 0.0 < float(value) < inf),
        "a number above 0, or None",
    ),
}
"""Each argument with what tells whether it takes a value, and with what it must be."""


def require_arguments(**given: Any) -> None:
    """Refuses values that no run can take, whatever the FMUs are.

    Raises:
        WiringError: names the argument, the value and what is allowed.
    """
    for name, value in given.items():
        takes, allowed = ARGUMENTS[name]
        if not takes(value):
            raise WiringError(f"{name} = {plain(repr(value), 60)}: it must be {allowed}")
