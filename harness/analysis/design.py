"""Design of the damping controller: Riccati equations from the model and a few stated weights.

The estimator's gains are those of the stationary Kalman filter of its own model in contact, without
and with the wheel speed; the message, late and only once a cycle, enters as a delayed measurement of
a periodic system. The damping law is the linear-quadratic feedback of the relative motion of motor
and wheels, which leaves the motion of the vehicle alone.
"""

from dataclasses import dataclass
from math import sqrt
from types import SimpleNamespace
from typing import Any

import numpy as np
from scipy.linalg import expm, solve_discrete_are

from models import motor_torque_loop, two_mass_driveline, wheel_speed_can
from models.controller.supervision import T_S
from models.controller.torque_estimator import Estimate, integrated

PLANT = two_mass_driveline.Parameters()
MOTOR = motor_torque_loop.Parameters()
CAN = wheel_speed_can.Parameters()


@dataclass(frozen=True)
class Weights:
    """What the designer decides; standard deviations of the noise the estimator is to expect.

    Attributes:
        T_mot: error of the motor torque per sample, N.m.
        T_load: change of the load torque per sample that is not the slow one, N.m.
        phi: error of the twist per sample, rad.
        T_l: change of the slow load torque per sample, N.m.
        omega_2: error of a wheel-speed message, rad/s: its age, its resolution, the radius of the wheel.
        lambda_v: share of the gear torque that the vehicle takes. Vehicle and wheels moving as one
            give m r^2/i^2 / (m r^2/i^2 + J_2) = 0.83; with somewhat more the estimated wheels follow
            the motor less, which damps better (tipin50, tipout on the validation vehicle).
        damping: weight of the relative speed against the torque of the motor, N.m.s/rad.
        k_gap: factor on the damping inside the gap.
        omega_w: corner of the washout, rad/s; slow, so that little of the demand is withheld.
        withheld: time by which the feedback of the gear torque delays the impulse of a step, s.
        T_land, t_land: limit of the demand inside the gap, N.m, and how long it may act, s.
    """

    T_mot: float = 1.0
    T_load: float = 5.0
    phi: float = 1e-3
    T_l: float = 0.01
    omega_2: float = 2.0
    lambda_v: float = 0.913
    damping: float = 2.6
    k_gap: float = 0.665
    omega_w: float = 4.25
    withheld: float = 0.006
    T_land: float = 60.0
    t_land: float = 0.1


WEIGHTS = Weights()


def transition(p: Any) -> np.ndarray:
    """Matrix (4, 4) of one sample of the estimator's model in contact, deviations from a state there."""
    contact = Estimate(0.0, 0.0, 2.0 * p.phi_B, 0.0)
    base = np.array(integrated(contact, 0.0, T_S, p))
    columns = [
        np.array(integrated(Estimate(*(np.array(contact) + row).tolist()), 0.0, T_S, p)) - base for row in np.eye(4)
    ]
    return np.array(columns).T


def process_noise(w: Weights) -> np.ndarray:
    """Covariance (4, 4) of what the model does not know, per sample."""
    deviations = (T_S * w.T_mot / PLANT.J_1, T_S * w.T_load / PLANT.J_2, w.phi, w.T_l)
    return np.diag(np.square(deviations))


def speed_noise() -> float:
    """Variance of the measured motor speed: noise and rounding."""
    return MOTOR.sigma_omega**2 + MOTOR.q_omega**2 / 12.0


def motor_speed_gains(A: np.ndarray, Q: np.ndarray) -> np.ndarray:
    """Stationary Kalman gains (4,) with the motor speed alone."""
    H = np.eye(4)[:1]
    P = solve_discrete_are(A.T, H.T, Q, np.array([[speed_noise()]]))
    return P[:, 0] / (P[0, 0] + speed_noise())


def both_speed_gains(A: np.ndarray, Q: np.ndarray, T_age: float, w: Weights) -> tuple[np.ndarray, np.ndarray]:
    """Gains (4,) on the motor speed (mean over a cycle) and on a message, in the periodic optimum.

    The state is augmented by the past values of omega_2, so that a message measures the last of them.
    """
    delay, cycle = round(T_age / T_S), round(CAN.T_cyc / T_S)
    size = 4 + delay
    F, noise = np.zeros((size, size)), np.zeros((size, size))
    F[:4, :4], noise[:4, :4] = A, Q
    F[4, 1] = 1.0
    F[5:, 4:-1] = np.eye(delay - 1)
    H_1, H_2 = np.eye(size)[0], np.eye(size)[-1]
    P, gains = np.eye(size), []
    for k in range(400 * cycle):
        P = F @ P @ F.T + noise
        P, L_1 = _measured(P, H_1, speed_noise())
        gains = [*gains[1 - cycle :], L_1[:4]]
        if k % cycle == 0:
            P, L_2 = _measured(P, H_2, w.omega_2**2)
    return np.mean(gains, axis=0), L_2[:4]


def _measured(P: np.ndarray, H: np.ndarray, R: float) -> tuple[np.ndarray, np.ndarray]:
    """Covariance and gain after a scalar measurement H x with variance R."""
    L = P @ H / (H @ P @ H + R)
    return P - np.outer(L, H @ P), L


def damping_gain(w: Weights) -> float:
    """k_d in N.m.s/rad: discrete linear-quadratic feedback of (omega_1 - omega_2, phi) in contact.

    Only the relative speed is weighted, so the feedback of the twist is zero but for sampling.
    """
    stiffness = PLANT.C * (1.0 / PLANT.J_1 + (1.0 - w.lambda_v) / PLANT.J_2)
    continuous = np.array([[0.0, -stiffness, 1.0 / PLANT.J_1], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    F = expm(continuous * T_S)
    A, B = F[:2, :2], F[:2, 2:]
    S = solve_discrete_are(A, B, np.diag([w.damping**2, 0.0]), np.eye(1))
    return float(np.linalg.solve(np.eye(1) + B.T @ S @ B, B.T @ S @ A)[0, 0])


def design(w: Weights = WEIGHTS) -> dict[str, float]:
    """All parameters of the controller that are designed, by name."""
    model = SimpleNamespace(J_1=PLANT.J_1, J_2=PLANT.J_2, C=PLANT.C, phi_B=PLANT.phi_B, lambda_v=w.lambda_v)
    A, Q = transition(model), process_noise(w)
    T_age = 0.5 * CAN.T_cyc + 0.5 * (CAN.d_min + CAN.d_max)
    L = motor_speed_gains(A, Q)
    Lw, L_can = both_speed_gains(A, Q, T_age, w)
    states = Estimate._fields
    gains = {
        f"{name}_{state}": float(gain)
        for name, row in (("L", L), ("Lw", Lw), ("L_can", L_can))
        for state, gain in zip(states, row, strict=True)
    }
    return {
        "lambda_v": w.lambda_v,
        **gains,
        "T_age": T_age,
        "T_pred": sqrt(2.0) * MOTOR.tau,
        "k_d": damping_gain(w),
        "k_T": w.withheld * w.omega_w,
        "k_gap": w.k_gap,
        "omega_w": w.omega_w,
        "T_land": w.T_land,
        "t_land": w.t_land,
    }


def stored(parameters: dict[str, float]) -> str:
    """Designed parameters as TOML, to six significant digits."""
    return "".join(f"{name} = {float(f'{value:.6g}')!r}\n" for name, value in parameters.items())
