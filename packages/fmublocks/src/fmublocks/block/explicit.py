"""Steps of an explicit Runge-Kutta method, and how far off they are.

The error of a step is in units of what is tolerated: the root mean square over the states of the estimate
over TOLERANCE (|x| + small), where `small` is SMALL or SMALL_TWIST. The estimate of DOP853 is made of two, of
orders 5 and 3 (Hairer, Norsett, Wanner, "Solving Ordinary Differential Equations I", 2nd ed., section II.10).
"""

import math
from collections.abc import Callable, Iterable
from typing import Any

from .declaration import Real, variables
from .dop853 import B_3, ERROR_5, A, B
from .types import ContinuousBlock

TOLERANCE = 1e-5
"""Error of a step over the size of a state that is tolerated."""

SMALL, SMALL_TWIST = 1e-2, 1e-4
"""What is added to the size of a state: in its unit (rad/s, m/s, ...), and in rad or m, as springs are stiff."""

LEAST_CHANGE, MOST_CHANGE, SAFETY = 0.2, 5.0, 0.9
"""From one step to the next; of the length that the error allows."""

GREATEST = 1e300
"""Of the sums of squares from which an error is made; beyond it the error is without bound."""


class Work:
    """What a communication step has come to so far, in explicit steps."""

    steps = 0


Weights = dict[int, float]
"""Of the stages, by their numbers."""


def change(error: float, halvings: int) -> float:
    """Length of a step over that of the one before, whose error over what is allowed was that.

    As the error grows with h^q, it is SAFETY error^(-1/q), but LEAST_CHANGE to MOST_CHANGE (Hairer, Norsett, Wanner,
    section II.4); q, the order of the estimate plus 1, is 2^halvings here.
    """
    root = error
    for _ in range(halvings):
        root = math.sqrt(root)
    if root == 0.0:
        return MOST_CHANGE
    return min(max(SAFETY / root, LEAST_CHANGE), MOST_CHANGE) if root == root else LEAST_CHANGE


def small_sizes(block: ContinuousBlock) -> tuple[float, ...]:
    """What is added to the size of each state."""
    twists = {
        q.name for q in variables(block.State) if isinstance(q.declaration, Real) and q.declaration.unit in ("rad", "m")
    }
    return tuple(SMALL_TWIST if name in twists else SMALL for name in block.State._fields)


def tangent(block: ContinuousBlock) -> Callable[[Any, Any, Any, Any, float], Any]:
    """Function (x, dx, u, p, h) -> x + h dx."""
    return _stepper(block, ({},), {0: 1.0}, None)


def step(block: ContinuousBlock) -> Callable[[Any, Any, Any, Any, float], Any]:
    """Function (x, dx, u, p, h) -> x after one step of length h, dx being the derivative at x."""
    return _stepper(block, A, B, None)


def trial(block: ContinuousBlock) -> Callable[[Any, Any, Any, Any, float], tuple[Any, float]]:
    """Function (x, dx, u, p, h) -> the same x, and the error of the step: NaN or infinite where x is not finite."""
    return _stepper(block, A, B, (ERROR_5, B_3))


def _stepper(
    block: ContinuousBlock, stages: tuple[Weights, ...], end: Weights, errors: tuple[Weights, Weights] | None
) -> Callable[..., Any]:
    """Written out for the fields of the block's State (as NamedTuple writes its methods), which is ten times
    faster than looping over them."""
    size = len(block.State._fields)
    lines = ["new = tuple.__new__", "def step(x, dx, u, p, h):", f"    {_names('x', size)} = x"]
    lines.append(f"    {_names('k0_', size)} = dx")
    for stage, weights in enumerate(stages[1:], start=1):
        at = _state(f"x{n} + h * ({_sum(weights, n)})" for n in range(size))
        lines.append(f"    {_names(f'k{stage}_', size)} = f({at}, u, p)")
    if errors:
        lines += _judged(small_sizes(block), end, *errors)
    else:
        lines.append("    return " + _state(f"x{n} + h * ({_sum(end, n)})" for n in range(size)))
    scope: dict[str, Any] = {"f": block.derivative, "sqrt": math.sqrt, "State": block.State}
    exec("\n".join(lines), scope)
    return scope["step"]


def _judged(sizes: tuple[float, ...], end: Weights, error_5: Weights, end_3: Weights) -> list[str]:
    """Source of the end of a step and its error."""
    size, lines = len(sizes), ["    e5 = e3 = 0.0"]
    for n, small in enumerate(sizes):
        lines += [
            f"    s = {_sum(end, n)}",
            f"    y{n} = x{n} + h * s",
            f"    a, b = abs(x{n}), abs(y{n})",
            f"    w = {TOLERANCE!r} * ((a if a > b else b) + {small!r})",
            f"    e = ({_sum(error_5, n)}) / w",
            "    e5 += e * e",
            f"    e = (s - ({_sum(end_3, n)})) / w",
            "    e3 += e * e",
        ]
    lines += [
        f"    end = {_state(f'y{n}' for n in range(size))}",
        "    d = e5 + 0.01 * e3",
        f"    return end, h * e5 / sqrt({float(size)!r} * d) if 0.0 < d <= {GREATEST!r} else {GREATEST!r} * d",
    ]
    return lines


def _names(prefix: str, size: int) -> str:
    return "".join(f"{prefix}{n}, " for n in range(size))


def _sum(weights: Weights, n: int) -> str:
    """Source of the weighted stages of state n."""
    return " + ".join(f"{a!r} * k{stage}_{n}" for stage, a in weights.items())


def _state(values: Iterable[str]) -> str:
    """Source of a State."""
    return f"new(State, ({', '.join(values)},))"
