"""Wheel speed as the ABS unit computes it: from the times at which teeth pass the sensor.

Edge n lies at the angle (n + e(n mod 48)) 2 pi/48 with tooth errors e fixed for a run. At each call
of the unit the speed is the nominal angle between the newest edge and the newest edge of the last
call that had one, over the difference of their times; without a new edge it is at most one tooth
over the time since the last edge. The sensor cannot tell the direction.
"""

from typing import Annotated, Any, NamedTuple

from .declaration import Real
from .noise import normal, uniform
from .operators import floor, fmod, minimum, where

TEETH = 48.0
PITCH = 6.283185307179586 / TEETH


class ToothWheel(NamedTuple):
    """One wheel at its sensor; positions count teeth, times are in s."""

    position: Annotated[float, Real("1", "angle of the wheel")]
    omega: Annotated[float, Real("rad/s", "true speed at the last sample")]
    tooth: Annotated[float, Real("1", "number of the edge below the sensor position")]
    edge: Annotated[float, Real("1", "number of the edge passed last")]
    edge_age: Annotated[float, Real("s", "time since that edge passed")]
    reference: Annotated[float, Real("1", "number of the newest edge at the last call that had one")]
    reference_age: Annotated[float, Real("s", "time since that edge passed")]
    fresh: Annotated[float, Real("1", "1 with an edge since that call, else 0")]
    seen: Annotated[float, Real("1", "1 once a call had an edge, else 0")]
    speed: Annotated[float, Real("rad/s", "speed as of the last call")]


def edge_position(n: Any, stream: float, p: Any) -> Any:
    """Position of edge n with the error of its tooth (sigma_tooth in teeth)."""
    return n + p.sigma_tooth * normal(p.seed, stream, fmod(fmod(n, TEETH) + TEETH, TEETH))


def tooth_below(position: Any, stream: float, p: Any) -> Any:
    """Number of the last edge at or below the position."""
    nearest = floor(position + 0.5)
    return where(edge_position(nearest, stream, p) <= position, nearest, nearest - 1.0)


def start(omega: Any, stream: float, p: Any) -> ToothWheel:
    """At a random angle within one tooth, the speed known."""
    position = uniform(p.seed, stream + 2.0, 0.0)
    tooth = tooth_below(position, stream, p)
    return ToothWheel(position, omega, tooth, tooth, 0.0, tooth, 0.0, 0.0, 0.0, abs(omega))


def turn(w: ToothWheel, omega: Any, T_s: float, stream: float, p: Any) -> ToothWheel:
    """The wheel T_s later, at the speed omega then; an edge in between is timed by interpolation."""
    position = w.position + 0.5 * (w.omega + omega) * T_s / PITCH
    tooth = tooth_below(position, stream, p)
    passed = where(tooth > w.tooth, tooth, tooth + 1.0)
    way = position - w.position
    late = (position - edge_position(passed, stream, p)) / where(way == 0.0, 1.0, way) * T_s
    new = tooth != w.tooth
    return w._replace(
        position=position,
        omega=omega,
        tooth=tooth,
        edge=where(new, passed, w.edge),
        edge_age=where(new, late, w.edge_age + T_s),
        reference_age=w.reference_age + T_s,
        fresh=where(new, 1.0, w.fresh),
    )


def call(w: ToothWheel) -> ToothWheel:
    """The wheel after a call of the ABS unit; the first call with an edge takes the true speed."""
    time = w.reference_age - w.edge_age
    measured = abs(w.edge - w.reference) * PITCH / where(time > 0.0, time, 1.0)
    measured = where(w.seen > 0.0, measured, abs(w.omega))
    waited = minimum(w.speed, PITCH / where(w.edge_age > 0.0, w.edge_age, 1e-9))
    fresh = w.fresh > 0.0
    return w._replace(
        reference=where(fresh, w.edge, w.reference),
        reference_age=where(fresh, w.edge_age, w.reference_age),
        fresh=0.0,
        seen=where(fresh, 1.0, w.seen),
        speed=where(fresh, measured, waited),
    )
