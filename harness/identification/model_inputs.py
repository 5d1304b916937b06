"""Inputs of the model between the samples of a recording, and the motor speed that it is compared with."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline

from ..recordings.measurement import Measurement
from ..recordings.source import RecordingError
from .drive_train import STEPS, Parameters
from .time_shifts import integral, shifted
from .torque_loop import FittedLoop, fitted

UNEVEN = 0.05
"""Share of a sample by which its time may be off."""


@dataclass(frozen=True, eq=False)
class Drive:
    """Torques and motor speed, motor side.

    Attributes:
        T_s: between samples in s.
        omega_1: motor speed in rad/s, shape (n + 1,).
        T_mot, T_load: recorded torques in N.m, means over each of the STEPS parts of a sample, shape (n, STEPS).
    """

    T_s: float
    omega_1: np.ndarray
    T_mot: np.ndarray
    T_load: np.ndarray

    def __len__(self) -> int:
        return len(self.T_mot)

    def between(self, first: int, last: int) -> "Drive":
        """Samples first to last, without last."""
        at = slice(first, last)
        return replace(self, omega_1=self.omega_1[first : last + 1], T_mot=self.T_mot[at], T_load=self.T_load[at])

    def acting(self, p: Parameters, first: int = 0, last: int | None = None) -> "Drive":
        """Samples first to last, without last, with both torques when they acted."""
        last = len(self) if last is None else last
        piece = self.between(first, last)
        if p.shifts == (0.0, 0.0):
            return piece
        lates = np.array(p.shifts) / self.T_s
        T_mot, T_load = (shifted(of, first, last, late) for of, late in zip(self._integrals, lates, strict=True))
        return replace(piece, T_mot=T_mot, T_load=T_load)

    def d_acting(self, p: Parameters, first: int = 0, last: int | None = None) -> np.ndarray:
        """Derivatives of both torques of `acting` by their shifts in N.m/s, shape (2 STEPS, samples)."""
        last = len(self) if last is None else last
        lates = np.array(p.shifts) / self.T_s
        each = [shifted(of, first, last, late, derivative=1).T for of, late in zip(self._integrals, lates, strict=True)]
        return np.vstack(each) / self.T_s

    @cached_property
    def _integrals(self) -> tuple[BSpline, BSpline]:
        return integral(self.T_mot, self.T_s), integral(self.T_load, self.T_s)


def model_inputs(recording: Measurement) -> tuple[Drive, FittedLoop | None]:
    """The recording as the model takes it, and what motor control makes of the demand if that was recorded.

    The motor torque is that of the torque loop where the demand is known and explains it, so that it has no noise;
    else, as the load torque, the cubic spline through its samples. A straight line between them would bias J_2 by
    -.055 % at 2 ms. A load torque that was not recorded is 0.

    Raises:
        RecordingError: the samples are not evenly spaced.
    """
    time = recording.time
    T_s = float(time[-1] - time[0]) / (len(time) - 1)
    off = np.abs(np.diff(time) - T_s)
    if off.max() > UNEVEN * T_s:
        k = int(off.argmax())
        raise RecordingError(
            f"{recording.name}: samples must be {T_s:.6g} s apart to within {100.0 * UNEVEN:g} %; "
            f"after {time[k]:g} s it is {time[k + 1] - time[k]:.6g} s; record at a fixed rate, or give the time "
            "at which the samples were taken and not the one at which they arrived (--column time=NAME)"
        )
    loop = None if recording.T_ref is None else fitted(recording.T_ref, recording.T_mot, T_s)
    if loop is None or recording.T_ref is None or not loop.answers:
        T_mot = parts(recording.T_mot, T_s)
    else:
        T_mot = loop.loop.means(recording.T_ref, T_s, STEPS)[:-1]
    T_load = np.zeros_like(T_mot) if recording.T_load is None else parts(recording.T_load, T_s)
    return Drive(T_s, recording.omega_1, T_mot, T_load), loop


def parts(values: np.ndarray, T_s: float) -> np.ndarray:
    """Means of a signal of shape (n + 1,) over each part of its samples, by a cubic spline, shape (n, STEPS)."""
    n = len(values) - 1
    integral = make_interp_spline(np.arange(n + 1), values, k=3).antiderivative()
    return np.diff(integral(np.arange(STEPS * n + 1) / STEPS)).reshape(n, STEPS) * STEPS
