"""The poles of a sampled system as modes, and those of a drive train without and with damping."""

import numpy as np

from ....fmus.building.oscillation import Mode, mode, oscillation
from ....models.controller import T_S
from .linear_loop import LinearLoop
from .operating_point import Point

ABOUT = (0.5, 2.0)
"""Frequencies of the drive train in a loop, over the one that it has alone, between which its mode is looked for."""

MEANT = (
    "teeth in contact, the mode that a torque of the motor shows most in, half to twice the frequency without control"
)
"""What a drive train with control is given as."""


LEAST = 1e-6
"""Magnitude of a pole of a sample, below which it is a delay and swings at no frequency."""


def is_stable(loop: LinearLoop) -> bool:
    """Whether the closed loop is stable."""
    return bool(np.abs(np.linalg.eigvals(loop.closed())).max() < 1.0)


def alone(point: Point) -> Mode:
    """The drive train of a plant without control: the mode in which a torque of the motor shows most in its speed,
    in contact, rolling at 15 km/h."""
    return oscillation(point.plant, point.of("plant", point.plant))


def drive_train_mode(loop: LinearLoop, frequency: float) -> Mode:
    """The drive train in a loop (MEANT, in the gear torque), with the mean of samples without and with a message;
    without a mode about the frequency (Hz) that it has alone it does not swing."""
    mean = loop.mean
    poles, vectors = np.linalg.eig(mean.closed())
    shown = np.abs((mean.T_gear @ vectors) * np.linalg.solve(vectors, mean.B.astype(complex)))
    swings = _swing(poles)
    found = zip(shown[swings], map(mode, np.log(poles[swings]) / T_S), strict=True)
    low, high = (factor * frequency for factor in ABOUT)
    about = ((share, each) for share, each in found if low < each.frequency < high)
    return max(about, default=(0.0, Mode(frequency, 1.0)))[1]


def modes(loop: LinearLoop, gain: float = 1.0) -> list[Mode]:
    """The modes of the closed loop that swing, with what the controller adds times a gain.

    Over a cycle of more than one sample frequencies are known but for multiples of that of the cycle.
    """
    return [mode(s) for s in swinging_poles(loop, gain)]


def swinging_poles(loop: LinearLoop, gain: float = 1.0) -> np.ndarray:
    """The poles of the closed loop that swing, in 1/s, as of `modes`."""
    poles = np.linalg.eigvals(loop.closed(gain))
    return np.log(poles[_swing(poles)]) / (loop.cycle * T_S)


def _swing(poles: np.ndarray) -> np.ndarray:
    """Which poles of a cycle swing, one of each pair."""
    return (np.imag(poles) > 0.0) & (np.abs(poles) > LEAST)
