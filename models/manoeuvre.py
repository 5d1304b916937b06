"""What driver, brakes and road do: a source for tools that have none.

Demand, brake and slope are straight lines between points in time,

    y(t) = y_k + (y_(k+1) - y_k) (t - time_k) / (time_(k+1) - time_k)    for time_k <= t < time_(k+1)

held before the first point and behind the last that is used: the others are at the instant 1e6 s. Two points at one
instant are a jump, from which on the later one counts. On the demand come a sine whose crests are cut off, and a binary
torque,

    sine_amplitude clip(sine_steepness sin(2 pi sine_frequency t), -1, 1)
    bit_amplitude (2 b_k - 1),    k = floor(t/bit_time)

whose bits are 50 each in whole numbers, the first one the lowest; the last one is held. Instants are taken as whole
nanoseconds.
"""

from dataclasses import replace
from math import pi
from typing import Annotated, Any, NamedTuple

from fmublocks.block.declaration import Boolean, Real, Record, quantities, variables
from fmublocks.block.operators import clip, floor, logical_and, minimum, sin, where
from fmublocks.block.types import ContinuousBlock

from .physics.plant import Input as PlantInput

POINTS = 64
"""That a manoeuvre has at the most."""

WORDS, WORD = 8, 50
"""Numbers with bits, and bits in each: a float holds 53 exactly."""

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
    enable: Annotated[bool, Boolean("whether damping is to be on")]


_PLANT = {q.name: q.declaration for q in variables(PlantInput)}
_SIGNALS = {"T_driver": _PLANT["T_mot"], "T_brake": _PLANT["T_brake"], "slope": _PLANT["slope"]}
"""Unit and bounds, as the plants have them."""


def _point(k: int) -> dict[str, tuple[Any, float]]:
    """Declarations and start values of the parameters of a point."""
    time = Annotated[float, Real("s", f"instant of point {k}", 0.0, NEVER)]
    signals = {name: replace(declaration, description=f"{name} at point {k}") for name, declaration in _SIGNALS.items()}
    return {f"time_{k}": (time, NEVER)} | {f"{name}_{k}": (Annotated[float, q], 0.0) for name, q in signals.items()}


def _real(unit: str, description: str, low: float, high: float, start: float) -> tuple[Any, float]:
    return Annotated[float, Real(unit, description, low, high)], start


_TORQUE = _SIGNALS["T_driver"]

Parameters = quantities(
    "Parameters",
    {name: q for k in range(1, POINTS + 1) for name, q in _point(k).items()}
    | {
        "sine_amplitude": (Annotated[float, replace(_TORQUE, description="of the sine on the demand")], 0.0),
        "sine_frequency": _real("Hz", "of the sine on the demand", 0.0, 100.0, 1.0),
        "sine_steepness": _real("1", "of its flanks; above 1 its crests are cut off", 0.0, 100.0, 1.0),
        "bit_amplitude": (Annotated[float, replace(_TORQUE, description="of the binary torque on the demand")], 0.0),
        "bit_time": _real("s", "for which a bit of it lasts", 1e-3, NEVER, 1.0),
    }
    | {
        f"bits_{k}": _real("1", f"its bits {WORD * (k - 1)} to {WORD * k - 1}, as a whole number", 0.0, 2.0**WORD, 0.0)
        for k in range(1, WORDS + 1)
    }
    | {
        "enable_from": _real("s", "instant from which on damping is to be on", 0.0, NEVER, 0.0),
        "enable_until": _real("s", "instant from which on it is to be off", 0.0, NEVER, NEVER),
    },
)


def start(u: Input, p: Record) -> State:
    return State(t=0.0)


def derivative(x: State, u: Input, p: Record) -> State:
    return State(t=1.0)


def output(x: State, u: Input, p: Record) -> Output:
    t = floor(x.t * NANOSECONDS + 0.5) / NANOSECONDS
    return Output(
        T_driver=_line(t, "T_driver", p) + _sine(t, p) + _binary(t, p),
        T_brake=_line(t, "T_brake", p),
        slope=_line(t, "slope", p),
        enable=logical_and(t >= _of(p, "enable_from"), t < _of(p, "enable_until")),
    )


def _sine(t: float, p: Record) -> float:
    wave = sin(2.0 * pi * _of(p, "sine_frequency") * t)
    return _of(p, "sine_amplitude") * clip(_of(p, "sine_steepness") * wave, -1.0, 1.0)


def _binary(t: float, p: Record) -> float:
    k = minimum(floor(t / _of(p, "bit_time") + 1e-6), WORDS * WORD - 1.0)
    number = _of(p, "bits_1")
    for word in range(1, WORDS):
        number = where(k >= WORD * word, _of(p, f"bits_{word + 1}"), number)
    place = k - WORD * floor(k / WORD)
    for shift in (32, 16, 8, 4, 2, 1):  # the number without its lowest bits, as many as the place says
        number = where(place >= shift, floor(number / 2.0**shift), number)
        place = where(place >= shift, place - shift, place)
    bit = number - 2.0 * floor(0.5 * number)
    return _of(p, "bit_amplitude") * (2.0 * bit - 1.0)


def _of(p: Record, name: str) -> float:
    """The parameter of that name; the record is made of a table, so no type checker knows it."""
    return getattr(p, name)


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
    description="What driver, brakes and road do",
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
