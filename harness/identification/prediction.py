"""One-step predictions of motor speed and load torque by an extended Kalman filter.

The filter knows the motor torque as recorded, less its noise, and corrects itself by each sample of motor speed and
load torque. What it was off by before each correction, over its standard deviation, is the innovation; with true
parameters and noise they are white and of size 1 (L. Ljung, System Identification, 2nd ed., section 7.2).
"""

from dataclasses import dataclass
from functools import cache, cached_property
from itertools import product
from typing import Any, NamedTuple

import casadi as ca
import numpy as np
from scipy.ndimage import minimum_filter1d

from .buffered import Buffered
from .compiled_functions import compiled
from .drive_train import STEPS, Parameters, State, Vehicle, recorded_load, sample
from .model_inputs import LATEST, Drive

STATES = len(State._fields)
LOWER = [(row, column) for row in range(STATES) for column in range(row + 1)]
"""What of a covariance is carried along."""

CHANNELS = ("motor speed", "load torque")
"""That are predicted, in this order."""

RESISTANCE = 3.0
"""By which the torque that resists the vehicle wanders in N.m over the square root of a second."""

ROUNDING = 1e-3
"""Standard deviation in rad/s of what the equation of the wheel speed lacks in a sample."""

UNMEASURED = 1e6
"""Noise in N.m of a load torque that was not recorded."""


class Noise(NamedTuple):
    """Standard deviations of the white noise of the sensors, with their rounding.

    Attributes:
        omega_1: of the motor speed in rad/s.
        T_mot, T_load: of the torques in N.m.
    """

    omega_1: float
    T_mot: float
    T_load: float


@dataclass(frozen=True, eq=False)
class Predicted:
    """What each sample was predicted wrong by, for both CHANNELS.

    Attributes:
        size: over its standard deviation, shape (2, n).
        log_S: logarithm of the variance that the filter expects, in (rad/s)2 and (N.m)2, shape (2, n).
        states: after each sample, shape (n, states).
        counted: indices of the samples that count: a piece may begin in the middle of a swing, and of a torque that
            comes late the end is not known.
    """

    size: np.ndarray
    log_S: np.ndarray
    states: np.ndarray
    counted: np.ndarray

    @property
    def cost(self) -> float:
        """Minus the logarithm of the likelihood, but for a constant."""
        return 0.5 * float(np.sum(self.size[:, self.counted] ** 2 + self.log_S[:, self.counted]))

    @property
    def rms(self) -> np.ndarray:
        """Of the sizes of both channels: 1 where model and noise are right."""
        return np.sqrt(np.mean(self.size[:, self.counted] ** 2, axis=1))

    @property
    def errors(self) -> np.ndarray:
        """In rad/s and N.m, shape (2, n)."""
        return self.size * np.exp(0.5 * self.log_S)


BURN_IN = 0.2
"""Time in s until the filter has found its state."""

START = State(1.0, 5.0, 5.0, 0.1, 10.0, 20.0, 1.0, 8.0)  # type: ignore[arg-type]
"""Standard deviations of what it starts with."""

SIDES, TWIST_RATES = (-1.0, 0.0, 1.0), (-15.0, 0.0, 15.0)
"""Flanks, and speeds in rad/s by which the wheels turn faster, with which it may start."""

COMPARED = 0.4
"""Time in s by which these are compared."""


class Predictor:
    """The filter on a recording.

    Args:
        behind: what the tyre carries.
    """

    def __init__(self, drive: Drive, noise: Noise, behind: Vehicle) -> None:
        self.drive, self.noise, self.behind = drive, noise, behind
        load = np.zeros(len(drive) + 1) if drive.T_load is None else drive.T_load
        self._recorded = np.vstack([drive.omega_1, load])
        self.measured = drive.T_load is not None
        exact = np.zeros(len(drive) + 1, bool) if drive.exact is None else drive.exact
        # a late torque acts in the sample before or after
        self._noisy = 1.0 - minimum_filter1d(exact, 5)[1:]
        burn, late = round(BURN_IN / drive.T_s), round(LATEST / drive.T_s)
        pieces = (np.arange(a + min(burn, (b - a) // 2), b - late) for a, b in drive.pieces)
        self.counted = np.concatenate(list(pieces))

    def of(self, drive: Drive) -> "Predictor":
        """The same for another part of the recording."""
        return Predictor(drive, self.noise, self.behind)

    def predicted(self, p: Parameters, start: np.ndarray | None = None) -> Predicted:
        """
        Args:
            start: see `start`; None: that of these parameters.
        """
        starts = self.start(p) if start is None else start
        size, log_S = np.zeros((2, 2, len(self.drive)))
        states = np.zeros((len(self.drive), STATES))
        for begin, (first, last) in zip(starts, self.drive.pieces, strict=True):
            after, seen = self._pass(p, begin, first, last)
            size[:, first:last], log_S[:, first:last], states[first:last] = seen[:2], seen[2:], after[:STATES].T
        if not self.measured:
            size[1], log_S[1] = 0.0, 0.0
        return Predicted(size, log_S, states, self.counted)

    def start(self, p: Parameters) -> np.ndarray:
        """State and covariance at the first sample of each piece: the likeliest of several, since it may begin in the
        middle of a swing. They are compared by a filter that follows what comes, so that a wrong one is not lost."""
        return np.array([self._start(p, first, last) for first, last in self.drive.pieces])

    def _start(self, p: Parameters, first: int, last: int) -> np.ndarray:
        n, omega = min(round(COMPARED / self.drive.T_s), last - first), float(self.drive.omega_1[first])
        twist = p.phi_B + abs(float(self.drive.T_mot[first])) / p.C
        resists = -float(self._recorded[1, first : first + n // 4 + 1].mean())
        wide = p._replace(lack_1=max(p.lack_1, 0.1), lack_L=max(p.lack_L, 1.0))
        covariance = np.diag(np.square(START))

        def begin(side: float, rate: float) -> np.ndarray:
            x = State(omega, omega + rate, omega, side * twist, resists, -resists, 0.0, 0.0)  # type: ignore[arg-type]
            return np.concatenate([x, [covariance[at] for at in LOWER]])

        def cost(start: np.ndarray) -> float:
            _, seen = self._pass(wide, start, first, first + n)
            return float(np.sum(seen[:2] ** 2 + seen[2:]))

        return min((begin(side, rate) for side, rate in product(SIDES, TWIST_RATES)), key=cost)

    def _pass(self, p: Parameters, start: np.ndarray, first: int, last: int) -> list[np.ndarray]:
        n = last - first
        r_L = self.noise.T_load if self.measured else UNMEASURED
        once = np.array([*p, self.noise.omega_1, self.noise.T_mot, r_L, *self.behind, self.drive.T_s], dtype=float)
        constant = np.tile(once[:, None], (1, n))
        constant[len(p) + Noise._fields.index("T_mot")] *= self._noisy[first:last]
        inputs = self.drive.torque(p.late_T)[first:last].T, self._recorded[:, first + 1 : last + 1], constant
        return _filter().passed(n)(start, *inputs)


class _Filter:
    """The filter as a function of CasADi."""

    @cache  # noqa: B019 filters are few, and remain
    def passed(self, n: int) -> Buffered:
        """Through n samples."""
        return Buffered(self._sample.mapaccum("predictions", n))

    @cached_property
    def _sample(self) -> ca.Function:
        x, lower = ca.SX.sym("x", STATES), ca.SX.sym("lower", len(LOWER))
        T_mot, recorded = ca.SX.sym("T_mot", STEPS), ca.SX.sym("recorded", 2)
        once = ca.SX.sym("once", len(Parameters._fields) + len(Noise._fields) + len(Vehicle._fields) + 1)
        *values, r_1, r_T, r_L, J_v, d_low, omega_low, T_s = ca.vertsplit(once)
        p, behind = Parameters._make(values), Vehicle._make((J_v, d_low, omega_low))
        before = State._make(ca.vertsplit(x))
        ahead = ca.vertcat(*sample(before, T_mot, T_s, p, behind))
        F = ca.jacobian(ahead, x)
        at: Any = State._make(range(STATES))
        G = ca.SX(F[:, at.o_T])  # the noise of the torque acts over the sample as its offset does, but is gone then
        G[at.o_T] = 0.0
        P = ca.SX(STATES, STATES)
        for k, (row, column) in enumerate(LOWER):
            P[row, column] = P[column, row] = lower[k]
        P = F @ P @ F.T + r_T**2 * G @ G.T
        lacking = ((at.omega_1, p.lack_1), (at.omega_2, ROUNDING), (at.phi, p.lack_phi), (at.T_c, p.lack_L))
        for k, lack in (*lacking, (at.R, RESISTANCE * ca.sqrt(T_s))):
            P[k, k] += lack**2

        def corrected(x: ca.SX, P: ca.SX, channel: int, output: ca.SX, by: ca.SX, r: ca.SX) -> tuple[ca.SX, ...]:
            error, PH = recorded[channel] - output, P @ by.T
            S = by @ PH + r**2
            return x + PH / S * error, P - PH @ PH.T / S, error / ca.sqrt(S), ca.log(S)

        by_1 = ca.SX(1, STATES)
        by_1[at.omega_1] = 1.0
        x_1, P, size_1, log_1 = corrected(ahead, P, 0, ahead[at.omega_1], by_1, r_1)
        z = ca.SX.sym("z", STATES)
        load = recorded_load(State._make(ca.vertsplit(z)), T_mot[-1], p, behind)
        output, by_L = ca.substitute([load, ca.jacobian(load, z)], [z], [x_1])
        x_2, P, size_L, log_L = corrected(x_1, P, 1, output, by_L, r_L)
        after = ca.vertcat(x_2, *[P[place] for place in LOWER])
        inputs = [ca.vertcat(x, lower), T_mot, recorded, once]
        return compiled(ca.Function("prediction", inputs, [after, ca.vertcat(size_1, size_L, log_1, log_L)]))


_filter = cache(_Filter)
