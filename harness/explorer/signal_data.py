"""Manoeuvres as data, for a page that evaluates them as `harness.manoeuvres.signals` does."""

from base64 import b64encode
from typing import Any

import numpy as np

from ..loop import roles
from ..loop.places import STEP_SIZE
from ..manoeuvres.manoeuvre import Manoeuvre
from ..manoeuvres.signals import FlatSine, Held, Lines, Signal

FEW = 60
"""Numbers up to which a list stands as text."""


def manoeuvre_data(manoeuvre: Manoeuvre) -> dict[str, Any]:
    """What a run of it needs, and what its metrics refer to."""
    T_driver = signal_data(manoeuvre.T_driver, manoeuvre.duration)
    brake, slope = (signal_data(signal, manoeuvre.duration, 0.5) for signal in (manoeuvre.T_brake, manoeuvre.slope))
    return {
        "description": manoeuvre.description,
        "duration": manoeuvre.duration,
        "start": {roles.FIRST_SPEED: manoeuvre.v_0, roles.FIRST_TORQUE: manoeuvre.T_0}
        | {f"plant.{name}": float(value) for name, value in manoeuvre.road.items()},
        "inputs": {roles.DEMAND: T_driver, roles.BRAKE_TORQUE: brake, roles.SLOPE: slope},
        "t_0": manoeuvre.t_0,
        "dT": manoeuvre.dT,
    }


def signal_data(signal: Signal, duration: float, share: float = 0.0) -> dict[str, Any]:
    """One of `SIGNALS` in loop.js.

    Args:
        share: of a step, by which the instants are later at which a run asks for it.
    """
    match signal:
        case Lines(times, values):
            return {"kind": "lines", "times": numbers(times), "values": numbers(values)}
        case Held(interval, values):
            return {"kind": "held", "interval": interval, "values": numbers(values)}
        case FlatSine():
            return {"kind": "flat_sine", **vars(signal)}
    first = share * STEP_SIZE
    at = first + STEP_SIZE * np.arange(round(duration / STEP_SIZE) + 1)
    return {"kind": "sampled", "first": first, "interval": STEP_SIZE, "values": numbers(signal(at))}


def numbers(values: Any) -> Any:
    """A list, or many numbers as base64 of doubles, the lowest byte first."""
    array = np.asarray(values, dtype="<f8")
    return array.tolist() if len(array) <= FEW else {"f8": b64encode(array.tobytes()).decode()}
