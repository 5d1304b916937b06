"""A recording as the model takes it: the motor torque between samples, and what the model is compared with."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline

from driverecords.measurement import PIECE, Measurement
from driverecords.source import RecordingError

from .drive_train import STEPS
from .torque_loop import FittedLoop, fitted

UNEVEN = 0.05
"""Share of a sample by which its time may be off."""

FINE = 8
"""Instants a sample. A step of the demand makes a kink in the rate of the torque, which a spline through samples 2 ms
apart misses by more than its noise: a skew of half a sample was 7e-6 s off."""

GAP = 1.5
"""Times the interval from which on a step of time parts two pieces."""

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
        starts: first samples of the pieces, between which there are gaps.
        off: standard deviations of what the motor torque is off by, by the parameter that takes it.
        fine: motor torque at FINE instants from each sample on, shape (n + 1, FINE), if it is known between samples.
    """

    T_s: float
    omega_1: np.ndarray
    T_mot: np.ndarray
    T_load: np.ndarray | None
    exact: np.ndarray | None = None
    starts: tuple[int, ...] = (0,)
    off: Mapping[str, float] = field(default_factory=dict)
    fine: np.ndarray | None = None

    def __len__(self) -> int:
        """Samples after the first."""
        return len(self.omega_1) - 1

    @property
    def pieces(self) -> list[tuple[int, int]]:
        """First and last sample of each that has two or more."""
        every = zip(self.starts, [*(start - 1 for start in self.starts[1:]), len(self)], strict=True)
        return [(first, last) for first, last in every if last > first]

    @property
    def longest(self) -> slice:
        """The samples of the longest piece."""
        first, last = max(self.pieces, key=lambda piece: piece[1] - piece[0])
        return slice(first, last + 1)

    def between(self, first: int, last: int) -> "Drive":
        """From one sample to another one."""
        at = slice(first, last + 1)
        load, exact, fine = (None if of is None else of[at] for of in (self.T_load, self.exact, self.fine))
        starts = (0, *(start - first for start in self.starts if first < start <= last))
        return Drive(self.T_s, self.omega_1[at], self.T_mot[at], load, exact, starts, self.off, fine)

    def torque(self, late: float) -> np.ndarray:
        """The motor torque when it acted, where it was recorded so many seconds late: means over the STEPS parts of
        each sample of the cubic spline through the recorded ones, shape (n, STEPS), NaN between pieces. A straight line
        would bias J_2 by .055 % at 2 ms."""
        if late not in self._torques:
            if len(self._torques) > 1:  # a search moves one delay at a time
                self._torques.clear()
            means = np.full((len(self), STEPS), np.nan)
            for (first, last), integral in zip(self.pieces, self._integrals, strict=True):
                edges = np.arange(STEPS * (last - first) + 1) / STEPS + late / self.T_s
                means[first:last] = np.diff(integral(edges)).reshape(-1, STEPS) * STEPS
            self._torques[late] = means
        return self._torques[late]

    @cached_property
    def _torques(self) -> dict[float, np.ndarray]:
        """Those of the last delays."""
        return {}

    @cached_property
    def _integrals(self) -> list[BSpline]:
        """Of each piece, over the time in samples; LATEST beyond both ends the torque is held."""
        torque = self.T_mot[:, None] if self.fine is None else self.fine
        parts = torque.shape[1]
        beyond = int(np.ceil(LATEST / self.T_s)) * parts
        known = [torque[first:last].ravel() for first, last in self.pieces]
        ends = [torque[last, :1] for _, last in self.pieces]
        held = [np.pad(np.append(piece, end), beyond, mode="edge") for piece, end in zip(known, ends, strict=True)]
        return [make_interp_spline((np.arange(len(T)) - beyond) / parts, T, k=3).antiderivative() for T in held]


def drive_of(recording: Measurement) -> tuple[Drive, FittedLoop | None]:
    """The recording as the model takes it, and motor control if its demand was recorded.

    Where the torque is what motor control makes of the demand, it is taken from there, so that it has no noise.

    Raises:
        RecordingError: the samples are not evenly spaced.
    """
    time, steps = recording.time, np.diff(recording.time)
    within = steps < GAP * np.median(steps)
    T_s = float(np.mean(steps[within]))
    starts = (0, *(np.flatnonzero(~within) + 1).tolist())
    off = np.abs(steps - T_s) * within
    # of many gaps a clock that is not steady is the reason
    off = off if len(starts) * PIECE < 2.0 * T_s * len(time) else np.abs(steps - T_s)
    if off.max() > UNEVEN * T_s:
        k = int(off.argmax())
        raise RecordingError(
            f"{recording.name}: samples must be {T_s:.6g} s apart to within {100.0 * UNEVEN:g} %; "
            f"after {time[k]:g} s it is {time[k + 1] - time[k]:.6g} s; record at a fixed rate, or give the time "
            "at which the samples were taken and not the one at which they arrived (--column time=NAME)"
        )
    loop = None if recording.T_ref is None else fitted(recording.T_ref, recording.T_mot, T_s)
    if recording.T_ref is None or loop is None or not loop.answers:
        return Drive(T_s, recording.omega_1, recording.T_mot, recording.T_load, starts=starts), loop
    T_mot = np.where(loop.met, loop.torque, recording.T_mot)
    off = {"late_T": loop.lag, "g_T": loop.deviations["gain"] / loop.loop.gain}
    drive = Drive(T_s, recording.omega_1, T_mot, recording.T_load, loop.met, starts, off)
    return replace(drive, fine=_between_samples(drive, recording.T_ref, loop)), loop


def _between_samples(drive: Drive, T_ref: np.ndarray, loop: FittedLoop) -> np.ndarray:
    """See `Drive.fine`: by the demand where both samples are that of motor control, else by the spline through them."""
    ahead = np.arange(FINE) / FINE * drive.T_s
    by_demand = [replace(loop.loop, delay=loop.loop.delay - by).torque(T_ref, drive.T_s) for by in ahead]
    fine = np.repeat(drive.T_mot[:, None], FINE, axis=1)
    for (first, last), integral in zip(drive.pieces, drive._integrals, strict=True):
        at = np.arange(FINE * (last - first)) / FINE
        fine[first:last] = integral.derivative()(at).reshape(-1, FINE)
    both = loop.met & np.append(loop.met[1:], False)
    return np.where(both[:, None], np.column_stack(by_demand), fine)
