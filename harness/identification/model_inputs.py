"""A recording as the model takes it: the motor torque between samples, and what the model is compared with."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline

from ..recordings.measurement import Measurement
from ..recordings.source import RecordingError
from .drive_train import STEPS
from .torque_loop import FittedLoop, fitted

UNEVEN = 0.05
"""Share of a sample by which its time may be off."""

LATEST = 0.006
"""Time in s by which a torque may be early or late at most."""


@dataclass(frozen=True, eq=False)
class Drive:
    """Signals of a drive, motor side, each of shape (n + 1,).

    Attributes:
        T_s: between samples in s.
        omega_1: motor speed in rad/s.
        T_mot: recorded motor torque in N.m.
        T_load: recorded load torque in N.m; None: it was not.
        exact: where the motor torque is that of the demand, without noise; None: nowhere.
    """

    T_s: float
    omega_1: np.ndarray
    T_mot: np.ndarray
    T_load: np.ndarray | None
    exact: np.ndarray | None = None

    def __len__(self) -> int:
        """Samples after the first."""
        return len(self.omega_1) - 1

    def between(self, first: int, last: int) -> "Drive":
        """From one sample to another one."""
        at = slice(first, last + 1)
        load, exact = (None if of is None else of[at] for of in (self.T_load, self.exact))
        return replace(self, omega_1=self.omega_1[at], T_mot=self.T_mot[at], T_load=load, exact=exact)

    def torque(self, late: float) -> np.ndarray:
        """The motor torque when it acted, where it was recorded so many seconds late: means over the STEPS parts of
        each sample of the cubic spline through the recorded ones, shape (n, STEPS). A straight line would bias J_2 by
        .055 % at 2 ms."""
        if late not in self._torques:
            if len(self._torques) > 1:  # a search moves one delay at a time
                self._torques.clear()
            edges = np.arange(STEPS * len(self) + 1) / STEPS + late / self.T_s
            self._torques[late] = np.diff(self._integral(edges)).reshape(-1, STEPS) * STEPS
        return self._torques[late]

    @cached_property
    def _torques(self) -> dict[float, np.ndarray]:
        """Those of the last delays."""
        return {}

    @cached_property
    def _integral(self) -> BSpline:
        """Over the time in samples; LATEST beyond both ends the torque is held."""
        beyond = int(np.ceil(LATEST / self.T_s))
        held = np.pad(self.T_mot, beyond, mode="edge")
        return make_interp_spline(np.arange(-beyond, len(self) + beyond + 1), held, k=3).antiderivative()


def drive_of(recording: Measurement) -> tuple[Drive, FittedLoop | None]:
    """The recording as the model takes it, and motor control if its demand was recorded.

    Where the torque is what motor control makes of the demand, it is taken from there, so that it has no noise.

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
    if loop is None or not loop.answers:
        return Drive(T_s, recording.omega_1, recording.T_mot, recording.T_load), loop
    T_mot = np.where(loop.met, loop.torque, recording.T_mot)
    return Drive(T_s, recording.omega_1, T_mot, recording.T_load, loop.met), loop
