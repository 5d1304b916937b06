"""A block of the control loop: its declared records and its pure functions.

x is the state, u the input, p the parameters; all are named tuples of floats (booleans are bool,
whole numbers int; a field of a state may itself be a tuple, of fixed shape).

A *continuous* block has `derivative`; between the surfaces g_k(x, u, p) = 0 its equations are
smooth, at them they have kinks (no jumps). A *sampled* block has `update`:

    x(k+1) = update(x(k), u(k), p)    at the instants k T_s, k = 0, 1, 2, ...

and its output at k T_s <= t < (k+1) T_s is that of x(k): what it computes from the inputs at k T_s
appears at (k+1) T_s.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Block:
    """What a tool needs to run a block.

    Attributes:
        name: the name of the FMU.
        description: one line.
        Parameters, Input, State, Output: the declared named tuples.
        start: (u, p) -> x, the state at t = 0 with the inputs of that instant.
        output: (x, u, p) -> y; a sampled block does not use u.
        derivative: (x, u, p) -> dx/dt as a State, for a continuous block.
        surfaces: (x, u, p) -> tuple of floats whose zeros are located, for a continuous block.
        step_size: longest internal integration step in s, for a continuous block.
        update: (x, u, p) -> next x, for a sampled block.
        sample_time: T_s in s, for a sampled block.
        tolerates_bad_input: inputs are not refused; the block itself copes with NaN and the absurd.
    """

    name: str
    description: str
    Parameters: type
    Input: type
    State: type
    Output: type
    start: Callable[[Any, Any], Any]
    output: Callable[[Any, Any, Any], Any]
    derivative: Callable[[Any, Any, Any], Any] | None = None
    surfaces: Callable[[Any, Any, Any], tuple[Any, ...]] | None = None
    step_size: float = 0.0
    update: Callable[[Any, Any, Any], Any] | None = None
    sample_time: float = 0.0
    tolerates_bad_input: bool = False
