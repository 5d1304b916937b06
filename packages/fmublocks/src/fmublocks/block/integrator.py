"""Integrating a continuous block, with its kinks located instead of stepped over.

Between the zeros of its event indicators a block is smooth and the method has order 8. When an
indicator changes sign within a step, the step is shortened so that it ends just behind the zero; an
excursion that leaves and comes back within one step is found from the slopes at both ends. Where the
error of a step is more than is tolerated, the step is divided; where a block is so stiff that very many
would be needed, the stretch is left to an implicit method. Nothing is kept from one stretch to the next.
"""

import math
from typing import Any, NamedTuple

from .declaration import Record
from .explicit import GREATEST, TOLERANCE, Work, change, small_sizes, step, tangent, trial
from .implicit import Implicit
from .types import ContinuousBlock

STEP_TOLERANCE = 1e-9
"""In steps: a duration this little above whole steps takes no further one."""

LOCATION_TOLERANCE = 1e-13
"""Time in s within which a crossing is located; it moves the state by less than rounding does."""

RESOLUTION = 1e-12
"""In the unit of an event indicator (rad, rad/s, m/s): beyond its zero by less, nothing has crossed it."""

PROBE = 1e-7
"""Time in s over which the slope of an event indicator is taken."""

MOST_CROSSINGS = 16
"""Crossings located in one stretch; what rests on a zero may cross it without end."""

MOST_TRIALS = 400
"""Explicit steps tried in one stretch."""

COARSE_ERROR = 100.0
"""A step with more than this error is no step on which a crossing could be looked for."""

STIFF = 20.0
"""Fastest rate times length of a stretch, above which it is left to the implicit method: explicit steps are stable up
to 6, and one implicit step costs as much as four of them."""

POWER_ITERATIONS = 2
"""To find that rate: what a step fails by is hidden in its way by slow motion, but hardly in what that way does."""

MOST_WORK = 400_000
"""Of a communication step, in explicit steps of integration; a longer one is not begun beyond it. A native FMU makes as
many in a second, for a minute and more of driving with the car that the plants start as."""


class TooMuchWork(ArithmeticError):
    """Shorter communication steps are needed; the argument is the name of the state that changes fastest."""


class Start(NamedTuple):
    """Where a step starts: state, its derivative, what is held over the step, and the work up to it."""

    x: Record
    dx: Record
    u: object
    p: object
    work: Work


class Integrator:
    """Advances the state of one continuous block; keeps nothing between two calls."""

    def __init__(self, block: ContinuousBlock) -> None:
        self.derivative = block.derivative
        self.event_indicators = block.event_indicators
        self.step_size, self.allowed_error, self.State = block.step_size, block.allowed_error, block.State
        self.solution, self.held = block.solution, block.Input._make(0.0 for _ in block.Input._fields)
        self.step, self.trial, self.tangent = step(block), trial(block), tangent(block)
        self.implicit, self.small = Implicit(block), small_sizes(block)

    def advance(self, x: Record, u: object, p: object, duration: float) -> Any:
        """The state `duration` s later, with the inputs u held: by the solution in closed form, where it holds.

        Args:
            x, u, p: State, Input and Parameters of the block.
            duration: any time >= 0 in s, divided into equal stretches no longer than block.step_size.

        Raises:
            NotIntegrable: the state changes too fast to be followed.
            TooMuchWork: it can be followed, but not as far in a reasonable time.
        """
        if self.solution:
            holds, end = self.solution(x, u, self.held, p, duration)
            if holds:
                return end
        work = Work()
        stretches = max(1, math.ceil(duration / self.step_size - STEP_TOLERANCE))
        sides = self._sides(x, u, p)
        for _ in range(stretches):
            start = Start(x, self.derivative(x, u, p), u, p, work)
            x = self._advance_through(start, duration / stretches, sides)
        return x

    def _advance_through(self, start: Start, remaining: float, sides: list[bool]) -> Record:
        """The state after a stretch of length `remaining`, split at every event on its way.

        `sides` says on which side of each zero the state is, and is kept up to date. It is
        remembered rather than looked up: at a crossing the value is zero but for rounding.
        """
        (u, p, work), longest, located = start[2:], remaining, 0
        if work.steps > MOST_WORK:
            raise TooMuchWork(self.implicit.fastest(start.x, start.dx))
        for _ in range(MOST_TRIALS):
            length, crossed = min(remaining, longest), None
            x_end, error = self._try(start, length)
            if not error <= self.allowed_error and self._is_stiff(start, x_end, remaining):
                break
            if error <= COARSE_ERROR and located < MOST_CROSSINGS:
                crossings = self._crossings(start, length, x_end, sides)
                if crossings:
                    length, crossed = min(crossings)
                    x_end, error = self._try(start, length)
            if error <= self.allowed_error:
                remaining -= length
                if crossed is not None:
                    sides[crossed] = not sides[crossed]
                    located += 1
                if remaining <= LOCATION_TOLERANCE:
                    return x_end
                start = start._replace(x=x_end, dx=self.derivative(x_end, u, p))
            if crossed is None or not error <= self.allowed_error:
                longest = length * change(error / self.allowed_error, 3)
        x = self.implicit.advance(start.x, u, p, remaining, work)
        sides[:] = self._sides(x, u, p)
        return x

    def _try(self, start: Start, length: float) -> tuple[Record, float]:
        """The state after a step of that length, and how far off it is."""
        start.work.steps += 1
        return self.trial(*start[:4], length)

    def _is_stiff(self, start: Start, x_end: Record, remaining: float) -> bool:
        """Whether the state changes too fast for explicit steps.

        The fastest rate is found by power iteration from the way of a step that failed: what a small change of the
        state does to its derivative is a change that is faster, and the size of that over its own is the rate.
        """
        x, dx = start.x, start.dx
        way = [end - value for value, end in zip(x, x_end, strict=True)]
        size = self._size(way, x)
        for _ in range(POWER_ITERATIONS):
            if size == 0.0:
                return False
            if not size <= GREATEST:
                return True
            near = self.State._make(value + part / size for value, part in zip(x, way, strict=True))
            there = self.derivative(near, start.u, start.p)
            way = [fast - slow for fast, slow in zip(there, dx, strict=True)]
            size = self._size(way, x)
        return not remaining * size <= STIFF

    def _size(self, way: list[float], x: Record) -> float:
        """Of a change of the state x, in units of what is tolerated."""
        total = 0.0
        for part, value, small in zip(way, x, self.small, strict=True):
            e = part / (TOLERANCE * (abs(value) + small))
            total += e * e
        return math.sqrt(total)

    def _sides(self, x: Record, u: object, p: object) -> list[bool]:
        return [z > 0.0 for z in self.event_indicators(x, u, p)]

    def _crossings(self, start: Start, h: float, x_end: Record, sides: list[bool]) -> list[tuple[float, int]]:
        """Each crossing within a step of length h: length of the step to it, number of the event indicator."""
        if not sides:
            return []
        end = self.event_indicators(x_end, start.u, start.p)
        straight = self.event_indicators(self.tangent(*start[:4], h), start.u, start.p)
        crossings: list[tuple[float, int]] = []
        for n, side in enumerate(sides):
            beyond = h if is_beyond(end[n], side) else None
            if beyond is None and is_beyond(straight[n], side):
                beyond = self._excursion(n, start, h, x_end, side)
            if beyond is not None:
                crossings.append((self._locate(n, start, beyond, side), n))
        return crossings

    def _indicator(self, n: int, x: Record, start: Start) -> float:
        return self.event_indicators(x, start.u, start.p)[n]

    def _value(self, n: int, start: Start, length: float) -> float:
        start.work.steps += 1
        return self._indicator(n, self.step(*start[:4], length), start)

    def _slope(self, n: int, start: Start) -> float:
        """Time derivative of event indicator n."""
        probe = self.tangent(*start[:4], PROBE)
        return (self._indicator(n, probe, start) - self._indicator(n, start.x, start)) / PROBE

    def _excursion(self, n: int, start: Start, h: float, x_end: Record, side: bool) -> float | None:
        """Length of a step to beyond zero n, if the state goes there and is back before h."""
        dx_end = self.derivative(x_end, start.u, start.p)
        slope, slope_end = self._slope(n, start), self._slope(n, start._replace(x=x_end, dx=dx_end))
        if slope_end * slope >= 0.0:
            return None
        turn = h * slope / (slope - slope_end)
        return turn if is_beyond(self._value(n, start, turn), side) else None

    def _locate(self, n: int, start: Start, far: float, side: bool) -> float:
        """Shortest step that ends beyond zero n, to LOCATION_TOLERANCE or RESOLUTION; one of length `far` does.

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
                if abs(z) <= RESOLUTION:
                    break
            else:
                near, z_near, z_far = length, z, 0.5 * z_far if moved == "near" else z_far
                moved = "near"
            slow = 0 if bisect or width >= 2.0 * (far - near) else slow + 1
        return far


def is_beyond(z: float, side: bool) -> bool:
    """Whether an event indicator that was on that side of its zero (true for above) has crossed it."""
    return z < -RESOLUTION if side else z > RESOLUTION
