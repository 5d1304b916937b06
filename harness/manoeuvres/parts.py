"""The parts of which signals are made up; the sum of its parts is a signal, and beyond them each is zero.

    T_driver = summed([constant(-12.0), step(1.0, 112.0), sine(10.0, 5.0, begin=3.0, end=4.0)])

Instants are in s, frequencies in Hz, all else in the unit of the signal. Straight lines stay straight lines in a sum,
so that a step and its height can be told from them (`harness.manoeuvres.demand_shape`).

Raised is a ManoeuvreError, whose message is to stand after the name of the part.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import isfinite
from typing import TYPE_CHECKING

from toolground.errors import UserError

from ..loop.places import T_S
from .prbs import FEEDBACK, shift_register
from .signals import Lines, Signal, lines, nanoseconds

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike

LONGEST = 3600.0
"""Duration in s of a manoeuvre at the most; what is longer is a recorded drive."""

HIGHEST = 0.5 / T_S
"""Frequency in Hz at the most: of a faster one the controller would see another."""


ROUNDING = 1e-9
"""Part of a value by which the sum of straight lines may differ on both sides of an instant without being a jump."""


class ManoeuvreError(UserError):
    """A manoeuvre that cannot be driven; the message names what is wrong, its value, and what is allowed."""


@dataclass(frozen=True)
class Swept:
    """amplitude * sin(2 pi phase) between begin and end, its frequency going from first to last (Hz) along a line."""

    amplitude: float
    first: float
    last: float
    begin: float
    end: float

    def __call__(self, t: ArrayLike) -> np.ndarray:
        import numpy as np

        since = nanoseconds(t) - self.begin
        phase = since * (self.first + 0.5 * (self.last - self.first) * since / (self.end - self.begin))
        within = (since >= 0.0) & (nanoseconds(t) < self.end)
        return np.where(within, self.amplitude * np.sin(2.0 * np.pi * phase), 0.0)


@dataclass(frozen=True)
class Binary:
    """The amplitude or minus it, by bits that hold for `clock` s each and begin again, between begin and end."""

    amplitude: float
    clock: float
    bits: tuple[int, ...]
    begin: float
    end: float

    def __call__(self, t: ArrayLike) -> np.ndarray:
        import numpy as np

        now = nanoseconds(t)
        k = np.floor((now - self.begin) / self.clock + 1e-6).astype(int) % len(self.bits)
        values = self.amplitude * (2.0 * np.asarray(self.bits)[k] - 1.0)
        return np.where((now >= self.begin) & (now < self.end), values, 0.0)


@dataclass(frozen=True, eq=False)
class Sum:
    """Of several signals."""

    signals: Sequence[Signal]

    def __call__(self, t: ArrayLike) -> np.ndarray:
        import numpy as np

        return np.sum([signal(t) for signal in self.signals], axis=0)


def constant(value: float) -> Lines:
    """The value all the time."""
    require(value=value)
    return lines((0.0, value))


def points(points: Sequence[tuple[float, float]]) -> Lines:
    """Straight lines through (instant, value), held beyond both ends; two points at one instant are a jump."""
    if not points:
        raise ManoeuvreError("points = []: there must be one or more")
    for k, (time, value) in enumerate(points, 1):
        if not (0.0 <= time <= LONGEST):
            raise ManoeuvreError(f"point {k}: its instant {time:g} must be 0 to {LONGEST:g} s")
        if not isfinite(value):
            raise ManoeuvreError(f"point {k}: its value {value:g} must be a finite number")
    for (before, _), (after, _) in pairwise(points):
        if after < before:
            raise ManoeuvreError(f"the point at {after:g} s comes after that at {before:g} s; time must not run back")
    return lines(*points)


def step(at: float, height: float) -> Lines:
    """From an instant on the height."""
    require(at=at, height=height)
    return lines((at, 0.0), (at, height))


def ramp(begin: float, end: float, height: float) -> Lines:
    """From zero to the height between two instants, and that from then on."""
    require(begin=begin, end=end, height=height)
    return lines((begin, 0.0), (end, height))


def pulse(begin: float, end: float, height: float) -> Lines:
    """The height between two instants."""
    require(begin=begin, end=end, height=height)
    return lines((begin, 0.0), (begin, height), (end, height), (end, 0.0))


def sine(amplitude: float, frequency: float, begin: float = 0.0, end: float = LONGEST) -> Swept:
    """A sine that begins at zero."""
    require(amplitude=amplitude, frequency=frequency, begin=begin, end=end)
    return Swept(amplitude, frequency, frequency, begin, end)


def chirp(amplitude: float, first: float, last: float, begin: float, end: float) -> Swept:
    """A sine whose frequency goes from the first to the last along a straight line."""
    require(amplitude=amplitude, first=first, last=last, begin=begin, end=end)
    return Swept(amplitude, first, last, begin, end)


def prbs(amplitude: float, clock: float = 0.04, order: int = 9, begin: float = 0.0, end: float = LONGEST) -> Binary:
    """Pseudo-random binary: jumps between the amplitude and minus the amplitude, or stays, every `clock` s.

    Args:
        order: of the shift register; the bits begin again after 2**order - 1 of them.
    """
    require(amplitude=amplitude, clock=clock, begin=begin, end=end)
    if order not in FEEDBACK:
        raise ManoeuvreError(f"order = {order}: it must be one of {', '.join(map(str, FEEDBACK))}")
    return Binary(amplitude, clock, tuple(shift_register(2**order - 1, order)), begin, end)


KINDS: Mapping[str, Callable[..., Signal]] = {
    part.__name__: part for part in (constant, points, step, ramp, pulse, sine, chirp, prbs)
}
"""By name."""

UNITS = {"at": "s", "begin": "s", "end": "s", "clock": "s", "frequency": "Hz", "first": "Hz", "last": "Hz"}
"""Of arguments that are not in the unit of the signal."""

RANGES = {
    "at": (0.0, LONGEST),
    "begin": (0.0, LONGEST),
    "end": (0.0, LONGEST),
    "clock": (T_S, LONGEST),
    "frequency": (0.0, HIGHEST),
    "first": (0.0, HIGHEST),
    "last": (0.0, HIGHEST),
}


def require(**arguments: float) -> None:
    """
    Raises:
        ManoeuvreError: an argument is not finite or out of range; the end does not come after the begin.
    """
    for name, value in arguments.items():
        if not isfinite(value):
            raise ManoeuvreError(f"{name} = {value:g}: it must be a finite number")
        low, high = RANGES.get(name, (value, value))
        if not low <= value <= high:
            raise ManoeuvreError(f"{name} = {value:g}: it must be {low:g} to {high:g} {UNITS[name]}")
    if "end" in arguments and not arguments["begin"] < arguments["end"]:
        raise ManoeuvreError(f"end = {arguments['end']:g}: it must come after begin, {arguments['begin']:g} s")


def summed(parts: Iterable[Signal]) -> Signal:
    """The sum of the parts; of straight lines again such."""
    drawn, others = [], []
    for part in parts:
        (drawn if isinstance(part, Lines) else others).append(part)
    together = _added(drawn) if drawn else lines((0.0, 0.0))
    return Sum([together, *others]) if others else together


def _added(drawn: Sequence[Lines]) -> Lines:
    """The sum of straight lines, with a corner where one of them has one and a jump where one jumps."""
    import numpy as np

    drawn = [Lines(nanoseconds(part.times), part.values) for part in drawn]  # as they are evaluated
    times = np.unique(np.concatenate([part.times for part in drawn]))
    before, after = (np.sum([side(part, times) for part in drawn], axis=0) for side in (Lines.before, Lines.__call__))
    jumps = np.abs(after - before) > ROUNDING * np.maximum(np.abs(after), 1.0)
    corners = [
        (time, value)
        for time, left, right, jump in zip(*(x.tolist() for x in (times, before, after, jumps)), strict=True)
        for value in ([left, right] if jump else [right])
    ]
    return lines(*corners)
