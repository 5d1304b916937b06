"""Wheel speed as the ABS unit computes it: from the times at which teeth pass the sensor.

Edge n lies at the angle (n + e(n mod 48)) 2 pi/48 with tooth errors e fixed for a run. At each call
of the unit the speed is the nominal angle between the newest edge and the newest edge of the last
call that had one, over the difference of their times; without a new edge it is at most one tooth
over the time since the last edge. The sensor cannot tell the direction.
"""

from typing import Annotated, NamedTuple, Protocol

from fmublocks.block.declaration import Real
from fmublocks.block.noise import normals, uniform
from fmublocks.block.operators import branch, floor, logical_or, minimum, where

TEETH = 48.0
PITCH = 6.283185307179586 / TEETH


class ToothParameters(Protocol):
    """Those of the teeth, whatever else is in the record."""

    @property
    def sigma_tooth(self) -> float: ...
    @property
    def seed(self) -> int: ...


class ToothWheel(NamedTuple):
    """One wheel at its sensor; positions count teeth, times are in s since the start."""

    position: Annotated[float, Real("1", "angle of the wheel")]
    omega: Annotated[float, Real("rad/s", "true speed at the last sample")]
    tooth: Annotated[float, Real("1", "number of the edge below the sensor position")]
    below: Annotated[float, Real("1", "position of that edge")]
    above: Annotated[float, Real("1", "position of the edge after it")]
    edge: Annotated[float, Real("1", "number of the edge passed last")]
    edge_time: Annotated[float, Real("s", "time at which it passed")]
    reference: Annotated[float, Real("1", "number of the newest edge at the last call that had one")]
    reference_time: Annotated[float, Real("s", "time at which it passed, 0 before the first such call")]
    speed: Annotated[float, Real("rad/s", "speed as of the last call")]


def edge_position(n: float, stream: float, p: ToothParameters) -> float:
    """Position of edge n with the error of its tooth (sigma_tooth in teeth)."""
    return n + p.sigma_tooth * normals(p.seed, stream, n % TEETH)[0]


def tooth_below(position: float, stream: float, p: ToothParameters) -> float:
    """Number of the last edge at or below the position; no edge is off by half a tooth."""
    nearest = floor(position + 0.5)
    return where(edge_position(nearest, stream, p) <= position, nearest, nearest - 1.0)


def start(omega: float, stream: float, p: ToothParameters) -> ToothWheel:
    """At a random angle within one tooth, the speed known."""
    position = uniform(p.seed, stream + 2.0, 0.0)
    tooth = tooth_below(position, stream, p)
    return ToothWheel(
        position=position,
        omega=omega,
        tooth=tooth,
        below=edge_position(tooth, stream, p),
        above=edge_position(tooth + 1.0, stream, p),
        edge=tooth,
        edge_time=0.0,
        reference=tooth,
        reference_time=0.0,
        speed=abs(omega),
    )


def turn(w: ToothWheel, omega: float, time: float, T_s: float, stream: float, p: ToothParameters) -> ToothWheel:
    """The wheel at `time`, T_s later, at the speed omega then; an edge in between is noticed."""
    position = w.position + 0.5 * (w.omega + omega) * T_s / PITCH
    turned = w._replace(position=position, omega=omega)
    passed = logical_or(position < w.below, position >= w.above)
    return branch(passed, lambda: notice(turned, position - w.position, time, T_s, stream, p), lambda: turned)


def notice(w: ToothWheel, way: float, time: float, T_s: float, stream: float, p: ToothParameters) -> ToothWheel:
    """The wheel after it passed edges on its last way; the last of them is timed by interpolation."""
    tooth = tooth_below(w.position, stream, p)
    below, above = edge_position(tooth, stream, p), edge_position(tooth + 1.0, stream, p)
    forwards = tooth > w.tooth
    late = (w.position - where(forwards, below, above)) / where(way == 0.0, 1.0, way) * T_s
    return w._replace(
        tooth=tooth,
        below=below,
        above=above,
        edge=where(forwards, tooth, tooth + 1.0),
        edge_time=time - late,
    )


def call(w: ToothWheel, time: float) -> ToothWheel:
    """The wheel after a call of the ABS unit; the first call with an edge takes the true speed."""
    fresh = w.edge_time > w.reference_time
    lapse = w.edge_time - w.reference_time
    measured = abs(w.edge - w.reference) * PITCH / where(fresh, lapse, 1.0)
    measured = where(w.reference_time > 0.0, measured, abs(w.omega))
    age = time - w.edge_time
    waited = minimum(w.speed, PITCH / where(age > 0.0, age, 1e-9))
    return w._replace(
        reference=where(fresh, w.edge, w.reference),
        reference_time=where(fresh, w.edge_time, w.reference_time),
        speed=where(fresh, measured, waited),
    )
