"""What motor and design model do, as a linear function of the torque reference, for given contacts of the teeth.

A quantity is a matrix (m, 1 + n) over 1 and the torque reference u (n,) in N.m: its first column is constant.
"""

from functools import cache
from typing import NamedTuple

import numpy as np

from driveline.harness.loop.places import T_S
from driveline.harness.metrics.spectrum import DRIVE_TRAIN, TO_50_HZ, BandSpectrum

from .contacts import GAP, PARTS, Contacts
from .linear_car import OMEGA_1, OMEGA_2, PHI, STATES, LinearCar

N = len(STATES)


def value(rows: np.ndarray, u: np.ndarray) -> np.ndarray:
    """(m,) what a quantity (m, 1 + n) is for a torque reference u (n,)."""
    return rows[:, 1:] @ u + rows[:, 0]


class Horizon(NamedTuple):
    """What is free, and what is looked at. Samples are counted from the first that control can change.

    Attributes:
        demand: (samples,) in N.m, as the motor gets it without control.
        free: how many samples of the torque are chosen; after them it is the demand.
        head: samples in which the teeth may change their side.
        T_gear_before, a_body_before: (k,), outputs at the samples of the window that are before; no control changes
            them.
        window: samples of the window in which rms values are taken.
    """

    demand: np.ndarray
    free: int
    head: int
    T_gear_before: np.ndarray
    a_body_before: np.ndarray
    window: int


class Spectrum(NamedTuple):
    """What an rms is the norm of.

    Attributes:
        head: (rows, samples of the head), over the output there.
        rest: (rows, N + 1 + free), over the state at the end of the head, 1 and the torques.
    """

    head: np.ndarray
    rest: np.ndarray


class Prediction(NamedTuple):
    """For some contacts.

    Attributes:
        phi, slip: twist, and omega_1 - omega_2, at the beginnings of all parts of the head and at its end.
        T_gear_head, a_body_head: at the samples of the head.
        x: state at its end.
        T_gear_tail: at the samples after it, over the state at its end, 1 and the torques.
    """

    phi: np.ndarray
    slip: np.ndarray
    T_gear_head: np.ndarray
    a_body_head: np.ndarray
    x: np.ndarray
    T_gear_tail: np.ndarray
    T_gear_spectrum: Spectrum
    jerk_spectrum: Spectrum

    def T_gear(self, samples: np.ndarray) -> np.ndarray:
        """At these samples, which rise."""
        head = len(self.T_gear_head)
        early, late = samples[samples < head], samples[samples >= head] - head
        return np.vstack([self.T_gear_head[early], self._after(self.T_gear_tail[late])])

    def T_gear_parts(self) -> np.ndarray:
        """Their norm is the metric `gear_torque_rms`."""
        return self._parts(self.T_gear_spectrum, self.T_gear_head)

    def jerk_parts(self) -> np.ndarray:
        """Their norm is the metric `jerk_rms_to_50_Hz`."""
        return self._parts(self.jerk_spectrum, self.a_body_head)

    def _parts(self, spectrum: Spectrum, head: np.ndarray) -> np.ndarray:
        parts = self._after(spectrum.rest)
        early = 1 + len(head)  # later torques change nothing in the head
        parts[:, :early] += spectrum.head @ head[:, :early]
        return parts

    def _after(self, rows: np.ndarray) -> np.ndarray:
        """Over 1 and the torques, of what is over the state at the end of the head too."""
        early, result = 1 + len(self.T_gear_head), rows[:, N:].copy()
        result[:, :early] += rows[:, :N] @ self.x[:, :early]
        return result


class Predictor:
    """The car of a manoeuvre; what does not depend on the switching times is computed once."""

    def __init__(self, car: LinearCar, horizon: Horizon, last: int) -> None:
        """last: side of the teeth after the head."""
        self.car, self.horizon = car, horizon
        head = slice(0, horizon.head)
        self.heads = {side: car.steps(head, side, PARTS) for side in (-1, GAP, 1)}
        self.a_head = car.acceleration(head)
        self.T_gear_tail, a_tail = self._tails(last)
        self.T_gear_spectrum = self._spectrum(horizon.T_gear_before, self.T_gear_tail, DRIVE_TRAIN, False)
        self.jerk_spectrum = self._spectrum(horizon.a_body_before, a_tail, TO_50_HZ, True)

    def predict(self, contacts: Contacts) -> Prediction:
        """For contacts whose last side is that after the head."""
        car, head = self.car, self.horizon.head
        X = np.zeros((N, 1 + head))  # the state over 1 and the torques
        X[:, 0] = car.x
        every = np.empty((head * PARTS + 1, N, 1 + head))
        sides = [contacts.side(part) for part in range(head * PARTS)]
        for part, side in enumerate(sides):
            every[part] = X
            steps, k = self.heads[side], part // PARTS
            X = steps.F[k] @ X
            X[:, 0] += steps.d[k]
            X[:, 1 + k] += steps.g[k]
        every[-1] = X
        samples, side = every[:-1:PARTS], np.array(sides[::PARTS])
        T_gear = car.C * samples[:, PHI]
        T_gear[:, 0] -= car.C * side * car.phi_B
        T_gear[side == GAP] = 0.0
        a_of, a_at = self.a_head
        a_body = np.einsum("kn,knm->km", a_of, samples)
        a_body[:, 0] += a_at
        return Prediction(
            phi=self._over_all(every[:, PHI]),
            slip=self._over_all(every[:, OMEGA_1] - every[:, OMEGA_2]),
            T_gear_head=self._over_all(T_gear),
            a_body_head=self._over_all(a_body),
            x=self._over_all(X),
            T_gear_tail=self.T_gear_tail,
            T_gear_spectrum=self.T_gear_spectrum,
            jerk_spectrum=self.jerk_spectrum,
        )

    def _over_all(self, X: np.ndarray) -> np.ndarray:
        """Of what is over 1 and the torques of the head."""
        return np.pad(X, ((0, 0), (0, self.horizon.free - self.horizon.head)))

    def _tails(self, last: int) -> tuple[np.ndarray, np.ndarray]:
        """T_gear and the body's acceleration after the head, over the state at its end, 1 and the torques."""
        car, h = self.car, self.horizon
        tail = slice(h.head, len(h.demand))
        steps, (a_of, a_at) = car.steps(tail, last), car.acceleration(tail)
        X = np.eye(N, N + 1 + h.free)
        T_gear, a_body = (np.empty((len(a_at), N + 1 + h.free)) for _ in range(2))
        for m, k in enumerate(range(h.head, len(h.demand))):
            T_gear[m], a_body[m] = car.C * X[PHI], a_of[m] @ X
            X = steps.F[m] @ X
            X[:, N] += steps.d[m]
            if k < h.free:
                X[:, N + 1 + k] += steps.g[m]
            else:
                X[:, N] += steps.g[m] * h.demand[k]
        T_gear[:, N] -= car.C * last * car.phi_B
        a_body[:, N] += a_at
        return T_gear, a_body

    def _spectrum(self, before: np.ndarray, tail: np.ndarray, band: tuple[float, float], derivative: bool) -> Spectrum:
        D = _parts_over_samples(self.horizon.window, band, derivative)
        known, early = len(before), len(before) + self.horizon.head
        rest = D[:, early:] @ tail[: D.shape[1] - early]
        rest[:, N] += D[:, :known] @ before
        return Spectrum(D[:, known:early], rest)


@cache
def _parts_over_samples(window: int, band: tuple[float, float], derivative: bool) -> np.ndarray:
    """(rows, window): real and imaginary parts of `BandSpectrum.parts` over the samples of the window."""
    parts = BandSpectrum(np.eye(window), T_S).parts(band, derivative)
    return np.vstack([np.real(parts), np.imag(parts)])
