"""The poles of a sampled system as modes, and those of a drive train without and with damping."""

from collections.abc import Mapping
from dataclasses import replace
from math import nan, pi
from typing import Any, NamedTuple

import numpy as np

from ....models.controller import T_S
from .linear_loop import LinearLoop, linear_loop
from .operating_point import Point


class Mode(NamedTuple):
    """A pole: frequency in Hz, damping ratio (1 if it does not swing, negative if it grows)."""

    frequency: float
    damping_ratio: float


DRIVE_TRAIN = (2.0, 16.0)
"""In Hz; below are the pitching of the body and the speed of the car, above mounts and bushings."""


def is_stable(loop: LinearLoop) -> bool:
    """Whether the closed loop is stable."""
    return bool(np.abs(np.linalg.eigvals(loop.closed())).max() < 1.0)


def drive_train_mode(loop: LinearLoop) -> Mode:
    """The least damped mode of DRIVE_TRAIN; without one, NaN Hz and a damping ratio of 1."""
    low, high = DRIVE_TRAIN
    own = (mode for mode in modes(loop) if low < mode.frequency < high)
    return min(own, key=lambda mode: mode.damping_ratio, default=Mode(nan, 1.0))


def modes(loop: LinearLoop, gain: float = 1.0) -> list[Mode]:
    """The modes of the closed loop that swing, with what the controller adds times a gain.

    Over a cycle of more than one sample frequencies are known but for multiples of that of the cycle.
    """
    return [Mode(float(abs(s)) / (2.0 * pi), float(-s.real / abs(s))) for s in swinging_poles(loop, gain)]


def swinging_poles(loop: LinearLoop, gain: float = 1.0) -> np.ndarray:
    """The poles of the closed loop that swing, in 1/s, as of `modes`."""
    poles = np.linalg.eigvals(loop.closed(gain))
    return np.log(poles[(poles.imag > 0.0) & (np.abs(poles) > 1e-6)]) / (loop.cycle * T_S)


def swing(plant: Any, motor: Any, gains: Mapping[str, float]) -> tuple[Mode, Mode]:
    """The drive train without and with damping: its own mode, and the least damped one below twice its frequency.

    Vehicle and wheels move as one here, without the damping by the tyre; the wheel speed is not used.

    Args:
        plant, motor: parameters of the design model and of the motor.
        gains: parameters of the controller, beside those of the plant.
    """
    loop = rigid(plant, motor, gains)
    alone = min(modes(loop, gain=0.0), key=lambda mode: abs(mode.damping_ratio))
    slow = (mode for mode in modes(loop) if mode.frequency < 2.0 * alone.frequency)
    return alone, min(slow, key=lambda mode: mode.damping_ratio)


def rigid(plant: Any, motor: Any, gains: Mapping[str, float]) -> LinearLoop:
    """The loop in which the wheels carry the vehicle; arguments as of `swing`."""
    car = plant._replace(J_2=plant.J_2 + plant.m * plant.r**2 / plant.i**2, recorded_load=True)
    known = {name: getattr(plant, name) for name in ("J_1", "J_2", "C", "phi_B")}
    limits = {"T_max": motor.T_max, "tau": motor.tau}
    point = Point(T=0.2 * motor.T_max, wheel=False)
    given = {"plant": car._asdict(), "motor": motor._asdict(), "controller": known | limits | dict(gains)}
    return linear_loop(replace(point, parameters=given))
