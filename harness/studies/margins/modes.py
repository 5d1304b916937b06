"""The poles of a sampled system as modes, and those of a drive train without and with damping."""

from math import pi
from typing import NamedTuple

import numpy as np

from ....fmus.building.oscillation import oscillation
from ....models.controller import T_S
from .linear_loop import LinearLoop
from .operating_point import Point


class Mode(NamedTuple):
    """A pole: frequency in Hz, damping ratio (1 if it does not swing, negative if it grows)."""

    frequency: float
    damping_ratio: float


ABOUT = (0.5, 2.0)
"""Frequencies of the drive train in a loop, over the one that it has alone, between which its mode is looked for."""

MEANT = "teeth in contact, the least damped mode between half and twice the frequency without control"
"""What a drive train with control is given as."""


def is_stable(loop: LinearLoop) -> bool:
    """Whether the closed loop is stable."""
    return bool(np.abs(np.linalg.eigvals(loop.closed())).max() < 1.0)


def alone(point: Point) -> Mode:
    """The drive train of a plant without control: the mode in which a torque of the motor shows most in its speed,
    in contact, rolling at 15 km/h."""
    return Mode(*oscillation(point.plant, point.of("plant", point.plant)))


def drive_train_mode(loop: LinearLoop, frequency: float) -> Mode:
    """The drive train in a loop (MEANT), with the mean of samples without and with a message; without a mode about the
    frequency (Hz) that it has alone it does not swing."""
    low, high = (factor * frequency for factor in ABOUT)
    about = (mode for mode in modes(loop.mean) if low < mode.frequency < high)
    return min(about, key=lambda mode: mode.damping_ratio, default=Mode(frequency, 1.0))


def modes(loop: LinearLoop, gain: float = 1.0) -> list[Mode]:
    """The modes of the closed loop that swing, with what the controller adds times a gain.

    Over a cycle of more than one sample frequencies are known but for multiples of that of the cycle.
    """
    return [Mode(float(abs(s)) / (2.0 * pi), float(-s.real / abs(s))) for s in swinging_poles(loop, gain)]


def swinging_poles(loop: LinearLoop, gain: float = 1.0) -> np.ndarray:
    """The poles of the closed loop that swing, in 1/s, as of `modes`."""
    poles = np.linalg.eigvals(loop.closed(gain))
    return np.log(poles[(poles.imag > 0.0) & (np.abs(poles) > 1e-6)]) / (loop.cycle * T_S)
