"""One-step predictions of the motor speed by an extended Kalman filter, with their sensitivities to the parameters.

The filter knows the torques as recorded, less their noise, and corrects itself by each sample of the motor speed. What
it was off by before each correction, over its standard deviation, is the innovation; with true parameters and noise
they are white and of size 1 (L. Ljung, System Identification, 2nd ed., section 7.2).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import product

import casadi as ca
import numpy as np

from .buffered import Buffered
from .compiled_functions import compiled
from .drive_train import DELAYS, STEPS, Parameters, State, d_torques_by, sample
from .model_inputs import Drive
from .time_shifts import MOST

STATES = len(State._fields)
LOWER = [(row, column) for row in range(STATES) for column in range(row + 1)]
"""What of a covariance is carried along."""


@dataclass(frozen=True)
class Noise:
    """Standard deviations of the noise of a sample, white.

    Attributes:
        omega_1: of the recorded motor speed in rad/s, with its rounding.
        T_mot, T_load: of the recorded torques in N.m.
        phi: of what no equation of the twist has in it, in rad.
        acts: whether that of the torques acts on the car; else its sensors add it. See `Predicted.cost`.
    """

    omega_1: float
    T_mot: float
    T_load: float
    phi: float = 1e-4
    acts: bool = False

    def vector(self) -> np.ndarray:
        return np.array([self.omega_1, self.T_mot, self.T_load, self.phi])


@dataclass(frozen=True, eq=False)
class Predicted:
    """Attributes:
    size: what each sample was predicted wrong by, over its standard deviation, shape (n,).
    log_S: logarithm of the variance in (rad/s)2 that the filter expects of it, shape (n,).
    counted: samples that count: a recording may begin in the middle of a swing, and of a torque that comes late the
        end is not known.
    likelihood: whether the noise of the torques acts on the car, see `cost`.
    """

    size: np.ndarray
    log_S: np.ndarray
    counted: slice
    likelihood: bool

    @property
    def cost(self) -> float:
        """Minus the logarithm of the likelihood, but for a constant.

        If the noise of the torques is that of sensors, what acts is what was recorded less noise. Of all torques that
        may have acted the likeliest is taken, and the cost is the sum of squares (total least squares). The logarithm
        of the variance stands for their mean; it would bias what is hardly told apart: J_2 by 6 % where a delay of the
        load torque and damping are free.
        """
        return 0.5 * float(np.sum((self.size**2 + self.likelihood * self.log_S)[self.counted]))

    @property
    def rms(self) -> float:
        """Of size: 1 where model and noise are right."""
        return float(np.sqrt(np.mean(self.size[self.counted] ** 2)))


@dataclass(frozen=True, eq=False)
class Innovations(Predicted):
    """Attributes:
    d_size, d_log_S: derivatives by the free parameters, shape (n, parameters).
    """

    d_size: np.ndarray
    d_log_S: np.ndarray

    @property
    def gradient(self) -> np.ndarray:
        return self.scores.sum(axis=0)

    @property
    def scores(self) -> np.ndarray:
        """The share of each sample that counts in the gradient, shape (samples, parameters)."""
        at = self.counted
        return self.d_size[at] * self.size[at, None] + 0.5 * self.likelihood * self.d_log_S[at]

    @property
    def information(self) -> np.ndarray:
        """Fisher's, as these innovations show it. A half of what the variance tells is in d_size."""
        d_size, d_log_S = self.d_size[self.counted], self.d_log_S[self.counted]
        return d_size.T @ d_size + 0.25 * self.likelihood * d_log_S.T @ d_log_S


class Predictor:
    """The filter for a set of free parameters."""

    def __init__(self, free: Sequence[str]) -> None:
        self.free = tuple(free)
        self._columns = [Parameters._fields.index(name) for name in self.free]

    def innovations(self, drive: Drive, p: Parameters, noise: Noise) -> Innovations:
        n, acting = len(drive), drive.acting(p)
        d_torques = drive.d_acting(p) if {*DELAYS} & {*self.free} else np.zeros((2 * STEPS, n))
        start, d_start = _start(drive, p, noise)
        given = _given(acting, p, noise)
        _, _, seen, d_seen = _filter().passed_with_derivatives(n)(start, d_start, *given, d_torques)
        size, log_S = seen.copy()
        d_size, d_log_S = d_seen.reshape(2, n, -1)[:, :, self._columns]
        return Innovations(size, log_S, _counted(drive), noise.acts, d_size, d_log_S)


@dataclass(frozen=True, eq=False)
class Filtered(Predicted):
    """Attributes:
    states: after each sample, shape (n, states).
    """

    states: np.ndarray

    @property
    def errors(self) -> np.ndarray:
        """What the motor speed was predicted wrong by in rad/s."""
        return self.size * np.exp(0.5 * self.log_S)


def filtered(drive: Drive, p: Parameters, noise: Noise) -> Filtered:
    """The filter without derivatives, in a fifth of the time."""
    acting = drive.acting(p)
    start, _ = _start(drive, p, noise)
    after, seen = _filter().passed(len(drive))(start, *_given(acting, p, noise))
    size, log_S = seen.copy()
    return Filtered(size, log_S, _counted(drive), noise.acts, after[:STATES].T.copy())


def _counted(drive: Drive) -> slice:
    return slice(min(round(BURN_IN / drive.T_s), len(drive) // 2), len(drive) - round(MOST / drive.T_s))


def _given(drive: Drive, p: Parameters, noise: Noise) -> tuple[np.ndarray, ...]:
    n = len(drive)
    once = [np.tile(np.array(values, dtype=float)[:, None], (1, n)) for values in (p, noise.vector(), [drive.T_s])]
    return drive.T_mot.T, drive.T_load.T, drive.omega_1[None, 1:], *once


BURN_IN = 0.2
"""Time in s until the filter has found its state."""

START = (1.0, 5.0, 0.1, 2.0, 2.0)
"""Standard deviations of the state that the filter starts with, in the units of `State`."""

SIDES, TWIST_RATES = (-1.0, 0.0, 1.0), (-15.0, 0.0, 15.0)
"""Flanks, and speeds in rad/s by which the wheels turn faster, with which it may start."""

COMPARED = 0.4
"""Time in s by which these are compared."""


def _start(drive: Drive, p: Parameters, noise: Noise) -> tuple[np.ndarray, np.ndarray]:
    """State and covariance at the first sample, and their derivatives by all parameters: the likeliest of several,
    since a recording may begin in the middle of a swing."""
    piece = drive.acting(p, 0, min(round(COMPARED / drive.T_s), len(drive)))
    run, given = _filter().passed(len(piece)), _given(piece, p, noise)
    T_0 = abs(float(drive.T_mot[0, 0]))

    def start(side: float, twist_rate: float) -> np.ndarray:
        x = [drive.omega_1[0], drive.omega_1[0] + twist_rate, side * (p.phi_B + T_0 / p.C), 0.0, 0.0]
        P = np.diag(np.square(START))
        return np.concatenate([x, [P[at] for at in LOWER]])

    def cost(begin: tuple[float, float]) -> float:
        _, (size, log_S) = run(start(*begin), *given)
        return float(np.sum(size**2 + log_S))

    side, twist_rate = min(product(SIDES, TWIST_RATES), key=cost)
    d = np.zeros((STATES + len(LOWER), len(p)))
    d[2, Parameters._fields.index("C")] = -side * T_0 / p.C**2
    d[2, Parameters._fields.index("phi_B")] = side
    return start(side, twist_rate), d


class _Filter:
    """The filter as functions of CasADi."""

    def __init__(self) -> None:
        self.x, self.lower = ca.SX.sym("x", STATES), ca.SX.sym("lower", len(LOWER))
        self.p, self.noise, self.T_s = ca.SX.sym("p", len(Parameters._fields)), ca.SX.sym("noise", 4), ca.SX.sym("T_s")
        T_mot, T_load, omega_1 = ca.SX.sym("T_mot", STEPS), ca.SX.sym("T_load", STEPS), ca.SX.sym("omega_1")
        self.torques = ca.vertcat(T_mot, T_load)
        self.given = [T_mot, T_load, omega_1, self.p, self.noise, self.T_s]
        self.state = ca.vertcat(self.x, self.lower)
        self.after, self.seen = self._step(T_mot, T_load, omega_1)

    def _step(self, T_mot: ca.SX, T_load: ca.SX, omega_1: ca.SX) -> tuple[ca.SX, ca.SX]:
        p = Parameters._make(ca.vertsplit(self.p))
        r, q_T, q_L, q_phi = ca.vertsplit(self.noise**2)
        P = ca.SX(STATES, STATES)
        for k, (row, column) in enumerate(LOWER):
            P[row, column] = P[column, row] = self.lower[k]
        x = ca.vertcat(*sample(State(*ca.vertsplit(self.x)), ca.vertsplit(T_mot), ca.vertsplit(T_load), self.T_s, p))
        F = ca.jacobian(x, self.x)
        G = F[:, 3:5]  # the noise of a torque acts over the sample as its offset does, but is gone then
        G[3:, :] = 0.0
        P = F @ P @ F.T + G @ ca.diag(ca.vertcat(q_T, q_L)) @ G.T
        P[2, 2] += q_phi
        error, S = omega_1 - x[0], P[0, 0] + r
        K = P[:, 0] / S
        x, P = x + K * error, P - K @ P[0, :]
        return ca.vertcat(x, *[P[at] for at in LOWER]), ca.vertcat(error / ca.sqrt(S), ca.log(S))

    @cache  # noqa: B019 filters are few, and remain
    def passed(self, n: int) -> Buffered:
        """Through n samples."""
        return Buffered(self.alone.mapaccum("predictions", n))

    @cache  # noqa: B019
    def passed_with_derivatives(self, n: int) -> Buffered:
        """Through n samples, with derivatives."""
        return Buffered(self.with_derivatives.mapaccum("predictions", n, 2))

    @cached_property
    def alone(self) -> ca.Function:
        return compiled(ca.Function("prediction", [self.state, *self.given], [self.after, self.seen]))

    @cached_property
    def with_derivatives(self) -> ca.Function:
        n, m = self.state.numel(), self.p.numel()
        d_state, d_torques = ca.SX.sym("d_state", n, m), ca.SX.sym("d_torques", 2 * STEPS)
        by_p = d_torques_by(Parameters._fields, d_torques)
        all_after, all_before = ca.vertcat(self.after, self.seen), ca.vertcat(self.state, self.p, self.torques)
        d = ca.jtimes(all_after, all_before, ca.vertcat(d_state, ca.DM.eye(m), by_p))
        given = [self.state, d_state, *self.given, d_torques]
        return compiled(ca.Function("sensitivity", given, [self.after, d[:n, :], self.seen, d[n:, :]]))


_filter = cache(_Filter)
