"""Integrating a continuous block, with its kinks located instead of stepped over.

Between the zeros of its event indicators a block is smooth and the method has order 8. When an
indicator changes sign within a step, the step is shortened so that it ends just behind the zero; an
excursion that leaves and comes back within one step is found from the slopes at both ends.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from .dop853 import A, B
from .types import ContinuousBlock

STEP_TOLERANCE = 1e-9
"""In steps: a duration this little above whole steps takes no further one."""

LOCATION_TOLERANCE = 1e-13
"""Time in s within which a crossing is located; it moves the state by less than rounding does."""

PROBE = 1e-7
"""Time in s over which the slope of an event indicator is taken."""

MOST_CROSSINGS = 16
"""Crossings located in one step; what rests on a zero may cross it without end."""


Tableau = tuple[tuple[dict[int, float], ...], dict[int, float]]
"""Explicit Runge-Kutta method: weights of the earlier stages in each stage, of the stages in the step."""

EULER: Tableau = (({},), {0: 1.0})


def stepper(block: ContinuousBlock, tableau: Tableau) -> Callable[[Any, Any, Any, Any, float], Any]:
    """Function (x, dx, u, p, h) -> x after one step of length h, dx being the derivative at x.

    It is written out for the fields of the block's State (as NamedTuple writes its methods), which
    is ten times faster than looping over them.
    """
    fields = block.State._fields
    stages, step = tableau
    lines = [f"def step(x, dx, u, p, h, f=f, new=new, State=State):\n    {_targets('x', fields)} = x"]
    lines.append(f"    {_targets('k0_', fields)} = dx")
    for stage, weights in enumerate(stages[1:], start=1):
        lines.append(f"    {_targets(f'k{stage}_', fields)} = f({_advanced(weights, fields)}, u, p)")
    lines.append(f"    return {_advanced(step, fields)}")
    scope: dict[str, Any] = {"f": block.derivative, "new": tuple.__new__, "State": block.State}
    exec("\n".join(lines), scope)
    return scope["step"]


def _targets(prefix: str, fields: tuple[str, ...]) -> str:
    return "".join(f"{prefix}{n}, " for n in range(len(fields)))


def _advanced(weights: dict[int, float], fields: tuple[str, ...]) -> str:
    """Source of the state advanced by h times the weighted stages."""
    sums = (" + ".join(f"{a!r} * k{j}_{n}" for j, a in weights.items()) for n in range(len(fields)))
    return "new(State, (" + ", ".join(f"x{n} + h * ({total})" for n, total in enumerate(sums)) + ",))"


class Start(NamedTuple):
    """Where a step starts: state, its derivative, and what is held over the step."""

    x: Any
    dx: Any
    u: Any
    p: Any


class Integrator:
    """Advances the state of one continuous block; keeps nothing between two calls."""

    def __init__(self, block: ContinuousBlock) -> None:
        self.derivative = block.derivative
        self.event_indicators = block.event_indicators
        self.step_size = block.step_size
        self.step = stepper(block, (A, B))
        self.tangent = stepper(block, EULER)

    def advance(self, x: Any, u: Any, p: Any, duration: float) -> Any:
        """The state `duration` s later, with the inputs u held.

        Args:
            x, u, p: State, Input and Parameters of the block.
            duration: any time >= 0 in s, divided into equal steps no longer than block.step_size.
        """
        steps = max(1, math.ceil(duration / self.step_size - STEP_TOLERANCE))
        sides = self._sides(x, u, p)
        for _ in range(steps):
            x = self._advance_through(x, u, p, duration / steps, sides)
        return x

    def _advance_through(self, x: Any, u: Any, p: Any, h: float, sides: list[bool]) -> Any:
        """The state after one step of length h, split at every event on its way.

        `sides` says on which side of each zero the state is, and is kept up to date. It is
        remembered rather than looked up: at a crossing the value is zero but for rounding.
        """
        for _ in range(MOST_CROSSINGS):
            start = Start(x, self.derivative(x, u, p), u, p)
            x_end = self.step(*start, h)
            crossings = self._crossings(start, h, x_end, sides)
            if not crossings:
                return x_end
            length, crossed = min(crossings)
            x = self.step(*start, length)
            sides[crossed] = not sides[crossed]
            h -= length
            if h <= LOCATION_TOLERANCE:
                return x
        return self.step(x, self.derivative(x, u, p), u, p, h)

    def _sides(self, x: Any, u: Any, p: Any) -> list[bool]:
        return [z > 0.0 for z in self.event_indicators(x, u, p)]

    def _crossings(self, start: Start, h: float, x_end: Any, sides: list[bool]) -> list[tuple[float, int]]:
        """Each crossing within a step of length h: length of the step to it, number of the event indicator."""
        if not sides:
            return []
        end = self._sides(x_end, start.u, start.p)
        straight = self._sides(self.tangent(*start, h), start.u, start.p)
        if end == sides == straight:
            return []
        found = []
        for n, side in enumerate(sides):
            beyond = h if end[n] != side else None
            if beyond is None and straight[n] != side:
                beyond = self._excursion(n, start, h, x_end, side)
            if beyond is not None:
                found.append((self._locate(n, start, beyond, side), n))
        return found

    def _indicator(self, n: int, x: Any, start: Start) -> float:
        return self.event_indicators(x, start.u, start.p)[n]

    def _value(self, n: int, start: Start, length: float) -> float:
        return self._indicator(n, self.step(*start, length), start)

    def _slope(self, n: int, start: Start) -> float:
        """Time derivative of event indicator n."""
        probe = self.tangent(*start, PROBE)
        return (self._indicator(n, probe, start) - self._indicator(n, start.x, start)) / PROBE

    def _excursion(self, n: int, start: Start, h: float, x_end: Any, side: bool) -> float | None:
        """Length of a step to beyond zero n, if the state goes there and is back before h."""
        dx_end = self.derivative(x_end, start.u, start.p)
        slope, slope_end = self._slope(n, start), self._slope(n, start._replace(x=x_end, dx=dx_end))
        if slope_end * slope >= 0.0:
            return None
        turn = h * slope / (slope - slope_end)
        return turn if (self._value(n, start, turn) > 0.0) != side else None

    def _locate(self, n: int, start: Start, far: float, side: bool) -> float:
        """Shortest step (to LOCATION_TOLERANCE) that ends beyond zero n; one of length `far` does.

        The Illinois variant of regula falsi (M. Dowell, P. Jarratt, BIT 11, 1971): when the same end
        moves twice, the value at the other counts half. Three steps without halving the bracket (an
        indicator on whose zero a block at rest lies is flat there) are followed by a bisection.
        """
        near, z_near, z_far = 0.0, self._indicator(n, start.x, start), self._value(n, start, far)
        if (z_near > 0.0) != side:
            z_near = 0.0
        moved, slow = "", 0
        while far - near > LOCATION_TOLERANCE:
            width = far - near
            bisect = slow == 3 or z_far == z_near
            length = near + 0.5 * width if bisect else far - z_far * width / (z_far - z_near)
            length = min(max(length, near + 0.3 * LOCATION_TOLERANCE), far - 0.3 * LOCATION_TOLERANCE)
            z = self._value(n, start, length)
            if (z > 0.0) != side:
                far, z_far, z_near = length, z, 0.5 * z_near if moved == "far" else z_near
                moved = "far"
            else:
                near, z_near, z_far = length, z, 0.5 * z_far if moved == "near" else z_far
                moved = "near"
            slow = 0 if bisect or width >= 2.0 * (far - near) else slow + 1
        return far
