"""What driver, brakes and road do, as straight lines between points in time: a source for tools that have none.

    y(t) = y_k + (y_(k+1) - y_k) (t - time_k) / (time_(k+1) - time_k)    for time_k <= t < time_(k+1)

held before the first point and behind the last that is used: the others are at the instant 1e6 s. Two points at one
instant are a jump, from which on the later one counts. Instants are taken as whole nanoseconds.
"""

from dataclasses import replace
from typing import Annotated, Any, NamedTuple

from .block.declaration import Real, Record, quantities, variables
from .block.operators import floor, logical_and, where
from .block.types import ContinuousBlock
from .physics.plant import Input as PlantInput

POINTS = 32
"""That a manoeuvre has at the most."""

NEVER = 1e6
"""Instant in s of points that are not used."""

NANOSECONDS = 1e9
"""In a second."""


class Input(NamedTuple):
    """Nothing: it is a source."""


class State(NamedTuple):
    t: Annotated[float, Real("s", "time since the start")]


class Output(NamedTuple):
    T_driver: Annotated[float, Real("N.m", "torque that the driver demands")]
    T_brake: Annotated[float, Real("N.m", "brake torque capacity of the driven wheels, wheel side", nominal=1000.0)]
    slope: Annotated[float, Real("rad", "slope of the road, positive uphill", nominal=0.1)]


_PLANT = {q.name: q.declaration for q in variables(PlantInput)}
_SIGNALS = {"T_driver": _PLANT["T_mot"], "T_brake": _PLANT["T_brake"], "slope": _PLANT["slope"]}
"""Unit and bounds, as the plants have them."""


def _point(k: int) -> dict[str, tuple[Any, float]]:
    """Declarations and start values of the parameters of a point."""
    time = Annotated[float, Real("s", f"instant of point {k}", 0.0, NEVER)]
    signals = {name: replace(one, description=f"{name} at point {k}") for name, one in _SIGNALS.items()}
    return {f"time_{k}": (time, NEVER)} | {f"{name}_{k}": (Annotated[float, q], 0.0) for name, q in signals.items()}


Parameters = quantities("Parameters", {name: q for k in range(1, POINTS + 1) for name, q in _point(k).items()})


def start(u: Input, p: Record) -> State:
    return State(t=0.0)


def derivative(x: State, u: Input, p: Record) -> State:
    return State(t=1.0)


def output(x: State, u: Input, p: Record) -> Output:
    t = floor(x.t * NANOSECONDS + 0.5) / NANOSECONDS
    return Output(*(_line(t, name, p) for name in Output._fields))


def _line(t: float, name: str, p: Record) -> float:
    """Of the quantity of that name at the instant t in s."""
    times, values = ([getattr(p, f"{what}_{k}") for k in range(1, POINTS + 1)] for what in ("time", name))
    y = values[0]
    for k in range(POINTS):
        after = min(k + 1, POINTS - 1)
        length = times[after] - times[k]
        goes_on = logical_and(length > 0.0, times[after] < NEVER)
        slope = where(goes_on, (values[after] - values[k]) / where(goes_on, length, 1.0), 0.0)
        y = where(t >= times[k], values[k] + slope * (t - times[k]), y)
    return y


BLOCK = ContinuousBlock(
    name="Manoeuvre",
    description="What driver, brakes and road do, as straight lines between points in time",
    module=__name__,
    Parameters=Parameters,
    Input=Input,
    State=State,
    Output=Output,
    start=start,
    output=output,
    derivative=derivative,
    step_size=0.01,
)
