"""Motor and design model, linear but for the backlash, along a run; exactly discretised.

    dx/dt = A x + B T_ref + c        T_gear = C (phi - side phi_B), 0 in the gap

A and c are those of the nonlinear model in the middle of a piece of the run, as long as the piece lasts: a sample
where the teeth move, 40 ms later on. What is left out is the product of two deviations from the run, of the wheel
speed and of the tyre's deflection.
"""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy.linalg import expm

from driveline.harness.loop.places import T_S
from driveline.harness.metrics.evaluate import at_samples
from driveline.harness.studies.margins.jacobians import rates
from driveline.harness.studies.margins.linear_plant import motor_and_plant
from driveline.harness.studies.margins.operating_point import MOTOR
from driveline.models import two_mass_driveline
from driveline.models.physics import vehicle

from .contacts import GAP

PLANT = two_mass_driveline.BLOCK
SYSTEM = motor_and_plant(PLANT)

STATES = ("motor_T_mot", "motor_dT_mot", "omega_1", "omega_2", "phi", "v", "u")
"""Those that the torque changes and that matter without a brake."""

OMEGA_1, OMEGA_2, PHI, V = (STATES.index(name) for name in ("omega_1", "omega_2", "phi", "v"))

SHORT, LONG, MOVING = 1, 20, 150
"""Samples in a piece, in the first MOVING samples and after them."""

UNLIMITED = 1e6
"""Torque in N.m that the motor of the linear car does not reach."""


class Steps(NamedTuple):
    """x(after) = F x(before) + g T_ref + d; stacks (samples, n, n), (samples, n), (samples, n)."""

    F: np.ndarray
    g: np.ndarray
    d: np.ndarray


class LinearCar(NamedTuple):
    """Along a run, from a sample on.

    Attributes:
        A, B, c: (pieces, n, n), (n,), (pieces, n), with the twist counted from the flank.
        piece: (samples,), which one a sample is in.
        C, phi_B: of the gear.
        x: (n,), the state at the beginning.
    """

    A: np.ndarray
    B: np.ndarray
    c: np.ndarray
    piece: np.ndarray
    C: float
    phi_B: float
    x: np.ndarray

    def steps(self, samples: slice, side: int, parts: int = 1) -> Steps:
        """Over a part of each of these samples, with the teeth on a side."""
        pieces, sample = np.unique(self.piece[samples], return_inverse=True)
        A, c = self.A[pieces], self.c[pieces]
        if side == GAP:
            A[:, :, PHI] = 0.0
        c -= side * self.phi_B * A[:, :, PHI]
        n = len(STATES)
        M = np.zeros((len(A), n + 2, n + 2))
        M[:, :n, :n], M[:, :n, n], M[:, :n, n + 1] = A, self.B, c
        E = expm(M * (T_S / parts))[sample]
        return Steps(E[:, :n, :n], E[:, :n, n], E[:, :n, n + 1])

    def acceleration(self, samples: slice) -> tuple[np.ndarray, np.ndarray]:
        """Rows (samples, n) and constants (samples,) of the body's acceleration, in m/s2, over the state."""
        pieces = self.piece[samples]
        return self.A[pieces, V], self.c[pieces, V]


def linear_car(results: np.ndarray, parameters: Mapping[str, float], first: int) -> LinearCar:
    """The car along a run of it.

    Args:
        results: of a run of the loop with the design model, without a brake, stationary up to the sample `first`.
        parameters: of the loop in it, `instance.name` -> value.
    """
    car = PLANT.Parameters(**_of("plant", parameters))
    tau = MOTOR.Parameters(**_of("motor", parameters)).tau
    p = (MOTOR.Parameters(tau=tau, T_max=UNLIMITED), car._replace(phi_B=0.0))
    fields = SYSTEM.State._fields
    columns = [fields.index(name) for name in STATES]

    def derivative(values: Sequence[Any]) -> list[Any]:
        *x, T_ref = values
        return list(SYSTEM.derivative(SYSTEM.State(*x), PLANT.Input(T_mot=T_ref), p))

    x = _states(at_samples(results)[first:], car)
    ends = [*range(0, MOVING, SHORT), *range(MOVING, len(x), LONG)]
    A, B, c = [], np.zeros(len(STATES)), []
    for begin, end in zip(ends, [*ends[1:], len(x)], strict=True):
        middle = 0.5 * (x[begin] + x[min(end, len(x) - 1)])
        middle[PHI] = 0.0  # the torque of the gear is linear in it
        at = np.zeros(len(fields) + 1)
        at[columns] = middle
        AB = rates(derivative, at.tolist(), [*columns, len(fields)]).mean[columns]
        A.append(AB[:, :-1])
        B = AB[:, -1]
        c.append(np.array(derivative(at.tolist()))[columns] - A[-1] @ middle)
    piece = np.repeat(np.arange(len(ends)), np.diff([*ends, len(x)]))
    return LinearCar(np.array(A), B, np.array(c), piece, car.C, car.phi_B, x[0])


def _of(instance: str, parameters: Mapping[str, float]) -> dict[str, Any]:
    """The parameters of an instance, by name."""
    start = f"{instance}."
    return {name.removeprefix(start): value for name, value in parameters.items() if name.startswith(start)}


def _states(sampled: np.ndarray, p: Any) -> np.ndarray:
    """(samples, n). The rate of the motor's torque is no output; the car is linear in it, and it starts at 0."""
    omega_2, v = sampled["plant.omega_2"], sampled["plant.v"]
    slip_speed = p.r * omega_2 / p.i - v
    F = sampled["plant.T_rim"] / p.r
    damping = np.array([vehicle.standstill_damping(speed, p) for speed in v.tolist()])
    u = (F - damping * slip_speed) * p.sigma_s / p.c_slip
    T_mot = sampled["motor.T_mot"]
    return np.column_stack([T_mot, 0.0 * T_mot, sampled["plant.omega_1"], omega_2, sampled["plant.phi"], v, u])
