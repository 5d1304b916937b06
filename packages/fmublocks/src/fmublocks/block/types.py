"""A block of the control loop: its declared records and its pure functions.

x is the state, u the input, p the parameters; all are named tuples of floats (booleans are bool,
whole numbers int; a field of a state may itself be a record or a tuple of fixed length).

Between the zeros of its event indicators z_k(x, u, p) the equations of a *continuous* block are
smooth; at them they have kinks (no jumps). A *sampled* block computes

    x(k+1) = update(x(k), u(k), p)    at the instants k T_s, k = 0, 1, 2, ...

and its output at k T_s <= t < (k+1) T_s is that of x(k): what it computes from the inputs at k T_s
appears at (k+1) T_s.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, TypeVar

from .declaration import with_defaults
from .frame import Frame


def no_event_indicators(x: object, u: object, p: object) -> tuple[float, ...]:
    """Of a block whose equations are smooth everywhere."""
    return ()


@dataclass(frozen=True, kw_only=True)
class _Block:
    """What every block has.

    Attributes:
        name: the name of the FMU.
        description: one line.
        module: where its equations stand; the docstring there explains them.
        Parameters, Input, State, Output: the declared named tuples.
        start: (u, p) -> x, the state at t = 0 with the inputs of that instant.
        output: (x, u, p) -> y; a sampled block that uses u passes it on within the instant (native only).
        tolerates_bad_input: inputs are not refused; the block itself copes with NaN and the absurd.
        frames: on a bus, that carry its quantities.
        gives_bad_output: NaN among the outputs is no mistake, but what the block is for (native build only).
    """

    name: str
    description: str
    module: str
    Parameters: type[Any]
    Input: type[Any]
    State: type[Any]
    Output: type[Any]
    start: Callable[[Any, Any], Any]
    output: Callable[[Any, Any, Any], Any]
    frames: tuple[Frame, ...] = ()
    tolerates_bad_input: bool = False
    gives_bad_output: bool = False


@dataclass(frozen=True, kw_only=True)
class ContinuousBlock(_Block):
    """A block of differential equations.

    Attributes:
        derivative: (x, u, p) -> dx/dt as a State.
        event_indicators: (x, u, p) -> tuple of floats whose zeros are located.
        solution: (x, u, du, p, h) -> whether the solution in closed form holds, and the state h seconds later, with
            inputs that move at the rates du; None: there is no such solution, and the block is integrated.
        next_event: (x, u, p) -> time in s, above 0, until outputs jump by themselves; None: they never do.
        step_size: longest step of the integration in s; where the block is stiff it takes shorter ones.
        allowed_error: of a step that is made, in units of what is tolerated (see .explicit). Steps with as little as
            usual are so short that a kink away from the zeros cannot pass for an accurate step.
    """

    derivative: Callable[[Any, Any, Any], Any]
    event_indicators: Callable[[Any, Any, Any], tuple[Any, ...]] = no_event_indicators
    solution: Callable[[Any, Any, Any, Any, Any], tuple[bool, Any]] | None = None
    next_event: Callable[[Any, Any, Any], Any] | None = None
    step_size: float
    allowed_error: float = 0.01


@dataclass(frozen=True, kw_only=True)
class SampledBlock(_Block):
    """A block that computes once a sample.

    Attributes:
        update: (x, u, p) -> next x.
        sample_time: T_s in s.
    """

    update: Callable[[Any, Any, Any], Any]
    sample_time: float


Block = ContinuousBlock | SampledBlock

AnyBlock = TypeVar("AnyBlock", bound=_Block)


def with_start_values(block: AnyBlock, values: Mapping[str, Any]) -> AnyBlock:
    """The block with other start values of the parameters of these names."""
    return replace(block, Parameters=with_defaults(block.Parameters, values))
