"""A system as data: which FMUs there are, what is connected, and what a run gives and wants to see."""

from collections.abc import Callable, Collection, Mapping
from ctypes import CDLL
from dataclasses import dataclass, field, replace
from enum import Enum
from functools import cached_property
from pathlib import Path
from typing import NamedTuple, NoReturn

from toolground.known_names import nearest
from toolground.plain_text import plain

from .errors import WiringError
from .limits import USUAL_LIMITS, Limits


class Scheme(Enum):
    """When an output reaches the inputs it feeds; docs/loop.md shows what each makes of the loop.

    `Scheme("jacobi")` is the scheme of that name.

    Raises:
        WiringError: there is none of that name.
    """

    PROPAGATED = "propagated"
    GAUSS_SEIDEL = "gauss-seidel"
    JACOBI = "jacobi"

    @classmethod
    def _missing_(cls, value: object) -> NoReturn:
        raise WiringError(f"unknown scheme {plain(value)}; {nearest(str(value), [scheme.value for scheme in cls])}")


class Connection(NamedTuple):
    """An output feeds an input, both written `instance.variable`, in a unit (None: that of the output)."""

    source: str
    target: str
    unit: str | None = None


class Port(NamedTuple):
    """A variable `instance.variable` that a run gives or reads, and its unit (None: not a Real)."""

    name: str
    unit: str | None

    @property
    def variable(self) -> str:
        """Its name without the instance."""
        return self.name.partition(".")[2]


@dataclass(frozen=True)
class System:
    """FMUs and how they are wired.

    Attributes:
        instances: name -> file of the FMU, in the order in which they step.
        connections: from outputs to inputs.
        inputs: what is fed from outside.
        parameters: what every run sets.
        outputs: what is evaluated after the run; other outputs are recorded too.
        mapping: `instance.variable` of the loop -> variable of the FMU.
        own: instances whose FMUs are the project's; those of the others run in a process of their own.
        limits: of the others.
        any_value: instances that put out NaN on purpose; with all others it ends the run.
        optional: variables that an FMU may lack, and the value that an input or parameter then stands for (None: any).
        offered: connections that are made where both FMUs have their end.
        lane_libraries: makes the library of each instance for runs in the lanes of the processor, or None where that is
            not possible; None: nothing does.
    """

    instances: Mapping[str, Path]
    connections: tuple[Connection, ...] = ()
    inputs: tuple[Port, ...] = ()
    parameters: tuple[Port, ...] = ()
    outputs: tuple[Port, ...] = ()
    mapping: Mapping[str, str] = field(default_factory=dict[str, str])
    optional: Mapping[str, float | None] = field(default_factory=dict[str, float | None])
    offered: tuple[Connection, ...] = ()
    own: frozenset[str] = frozenset()
    limits: Limits = USUAL_LIMITS
    any_value: frozenset[str] = frozenset()
    lane_libraries: "Callable[[System], dict[str, CDLL] | None] | None" = field(default=None, repr=False, compare=False)

    @cached_property
    def key(self) -> str:
        """The same for systems that are the same."""
        return repr(self)

    @property
    def ports(self) -> dict[str, list[Port]]:
        """All that the FMUs must have, by causality."""
        return {
            "input": [*self.inputs, *(Port(connection.target, connection.unit) for connection in self.connections)],
            "parameter": [*self.parameters],
            "output": [*self.outputs, *(Port(connection.source, connection.unit) for connection in self.connections)],
        }

    def without(self, names: Collection[str]) -> "System":
        """The system without the variables of these names, and what feeds them."""
        return replace(
            self,
            connections=tuple(connection for connection in self.connections if connection.target not in names),
            inputs=tuple(port for port in self.inputs if port.name not in names),
            parameters=tuple(port for port in self.parameters if port.name not in names),
            outputs=tuple(port for port in self.outputs if port.name not in names),
        )
