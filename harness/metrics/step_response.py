"""What the gear torque makes of a step of the demand."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..manoeuvres.manoeuvre import Manoeuvre
from .declaration import Absent
from .oscillation import SETTLED, damping_ratio, straight_line

FITTED = 0.9
"""Length in s of the end of a run to which the line of the final value is fitted."""

REACHED = 0.9
"""Share of its way that the response is measured to."""

LEAST_WAY = 0.1
"""Of the step of the demand, that the gear torque must make for its response to mean something."""


def height_of_step(manoeuvre: Manoeuvre, t: np.ndarray) -> float:
    """dT in N.m of a manoeuvre whose demand is a step at t_0: constant before, and from some instant on again.

    Raises:
        Absent: it is none (a pulse, for example), or the run ends too soon after it.
    """
    if manoeuvre.dT is None:
        raise Absent("the manoeuvre is no step")
    if t[-1] < manoeuvre.t_0 + FITTED:
        raise Absent(f"the run ends less than {FITTED:g} s after the step")
    before, after = (
        np.broadcast_to(np.asarray(manoeuvre.T_driver(part), dtype=float), part.shape)
        for part in (t[: max(1, int(np.searchsorted(t, manoeuvre.t_0 - 1e-9)))], t[t > t[-1] - FITTED])
    )
    start = before[0]
    tolerance = 1e-6 * abs(manoeuvre.dT)
    if not (abs(after - start - manoeuvre.dT) <= tolerance).all() or not tolerance > 0.0:
        raise Absent("the demand does not stay at the height of its step")
    if not (abs(before - start) <= tolerance).all():
        raise Absent("the demand is not constant before its step")
    return manoeuvre.dT


def settling_time(swing: np.ndarray, T_s: float, t_0: float, dT: float) -> float:
    """Time in s from t_0 to the last sample at which the swing of the gear torque exceeds SETTLED dT, plus one sample.

    Raises:
        Absent: it still does at the end.
    """
    exceeding = swing[round(t_0 / T_s) :] > SETTLED * abs(dT)
    if exceeding[-1]:
        raise Absent("the gear torque still swings when the run ends")
    last = np.flatnonzero(exceeding)
    return float(last[-1] + 1) * T_s if len(last) else 0.0


@dataclass(frozen=True, eq=False)
class Response:
    """What T_gear makes of a step, one element a sample.

    Attributes:
        T_gear: in N.m, from the beginning of the run.
        final: the line of its final value in N.m, from the beginning of the run.
        initial: its value before the step in N.m.
        first: sample of the step.
        T_s: time between samples in s.
    """

    T_gear: np.ndarray
    final: np.ndarray
    initial: float
    first: int
    T_s: float

    @property
    def way(self) -> float:
        """From the initial value to the line, at the step, in N.m."""
        return self.final[self.first] - self.initial

    @property
    def z(self) -> np.ndarray:
        """T_gear from its initial value, over its way, from the step on."""
        return (self.T_gear[self.first :] - self.initial) / self.way

    @cached_property
    def y(self) -> np.ndarray:
        """T_gear about the line of its final value, over its way."""
        return (self.T_gear - self.final) / self.way

    @cached_property
    def overshoot(self) -> float:
        """Over the line of the final value."""
        return max(0.0, float(self.y[self.first :].max()))

    @cached_property
    def delay(self) -> float:
        """Time in s until 90 % of the way are made.

        Raises:
            Absent: they never are.
        """
        reached = np.flatnonzero(self.z >= REACHED)
        if not len(reached):
            raise Absent("the gear torque never makes 90 % of its way")
        return float(reached[0] * self.T_s)

    @property
    def damping_ratio(self) -> float:
        """From 90 % of the way on; raises as `delay` does."""
        return damping_ratio(self.y, self.T_s, self.first + round(self.delay / self.T_s), self.overshoot)


def response(t: np.ndarray, T_gear: np.ndarray, t_0: float, dT: float) -> Response:
    """The response to a step of dT at t_0.

    The final value is a straight line fitted to the last 0.9 s and extended backwards (the torque of a car that gains
    speed drifts).

    Raises:
        Absent: the torque hardly moves.
    """
    T_s = float(t[1] - t[0])
    last = fitted(t)
    final = straight_line(t[last], T_gear[last], t)
    first = round(t_0 / T_s)
    found = Response(T_gear, final, initial_value(T_gear, first), first, T_s)
    if not abs(found.way) >= LEAST_WAY * abs(dT):
        raise Absent("the gear torque hardly follows the step of the demand")
    return found


def fitted(t: np.ndarray) -> np.ndarray:
    """Which instants the line of the final value is fitted to."""
    return t > t[-1] - FITTED + (t[1] - t[0]) / 2


def initial_value(T_gear: np.ndarray, first: int) -> float:
    """T_gear in N.m before a step at sample `first`; 0 if it was small."""
    before = float(T_gear[max(first - 1, 0)])
    return before if abs(before) >= 0.1 else 0.0
