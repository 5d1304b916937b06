"""Gains of the torque estimator: the Kalman filter of its own model, while the teeth are in contact.

The motor speed is measured at every sample; a message with the wheel speed comes late and only once a
cycle, as a delayed measurement of a periodic system.
"""

from dataclasses import replace

import numpy as np
from scipy.linalg import solve_discrete_are

from toolground.errors import UserError

from ...models.controller import T_S
from ...models.controller.torque_estimator import Estimate, Parameters, integrated
from .design_weights import Can, DriveTrain, Motor, Plant, Weights

SAMPLES = 4000
"""After so many samples the periodic gains have settled to a share of 1e-6."""


class DesignError(UserError):
    """There is no controller for this car; the text says why."""


def estimator_gains(
    plant: Plant, motor: Motor, can: Can, train: DriveTrain, weights: Weights, literal: bool = False
) -> dict[str, float]:
    """Gains on the motor speed, also while the wheels slip, and on a message.

    Args:
        literal: of the paper's observer as it stands, where the vehicle takes no share of the gear torque and there is
            no load; of the noise it knows the same.
    """
    states = Estimate._fields[:3] if literal else Estimate._fields
    own = slice(len(states))
    A = transition(plant, 0.0 if literal else train.lambda_v)[own, own]
    Q = process_noise(plant, motor, train, weights)[own, own]
    R_1, R_2 = speed_noise(motor), message_noise(plant, motor, can, train, weights)
    L, L_can = motor_speed_gains(A, Q, R_1), message_gains(A, Q, R_1, R_2, train.T_age, round(can.T_cyc / T_S))
    Q_slip = process_noise(plant, motor, train, replace(weights, slow_load_error=weights.slip_load_error))[own, own]
    Ls = motor_speed_gains(A, Q_slip, R_1)
    rows = {"L": L, "Ls": Ls, "L_can": L_can}
    return {
        f"{name}_{state}": float(gain) for name, row in rows.items() for state, gain in zip(states, row, strict=True)
    }


def transition(plant: Plant, lambda_v: float) -> np.ndarray:
    """Matrix (4, 4) of the estimator's model over a sample in contact, deviations from a state there."""
    model = Parameters(J_1=plant.J_1, J_2=plant.J_2, C=plant.C, phi_B=plant.phi_B, lambda_v=lambda_v)
    contact = np.array(Estimate(0.0, 0.0, 2.0 * plant.phi_B + 1.0, 0.0))
    base = np.array(integrated(Estimate(*contact.tolist()), 0.0, plant.phi_B, T_S, model))
    columns = [
        np.array(integrated(Estimate(*(contact + row).tolist()), 0.0, plant.phi_B, T_S, model)) - base
        for row in np.eye(4)
    ]
    return np.array(columns).T


def process_noise(plant: Plant, motor: Motor, train: DriveTrain, weights: Weights) -> np.ndarray:
    """Covariance (4, 4) of what the model does not know, per sample."""
    deviations = (
        T_S * weights.torque_error / plant.J_1,
        T_S * weights.load_error * (1.0 - train.lambda_v) / plant.J_2,
        weights.twist_error / plant.C,
        weights.slow_load_error,
    )
    return np.diag(np.square(motor.T_max * np.array(deviations)))


def speed_noise(motor: Motor) -> float:
    """Variance of the measured motor speed, (rad/s)^2: noise and rounding.

    Raises:
        DesignError: there is neither.
    """
    variance = motor.sigma_omega**2 + motor.q_omega**2 / 12.0
    if variance == 0.0:
        raise DesignError("sigma_omega and q_omega are 0: a motor speed without error leaves nothing to estimate")
    return variance


def message_noise(plant: Plant, motor: Motor, can: Can, train: DriveTrain, weights: Weights) -> float:
    """Variance of a wheel-speed message, (rad/s)^2: what the speed may have changed by since."""
    acceleration = motor.T_max / (plant.J_1 + plant.J_2 + train.M)
    return (weights.message_error * acceleration * (can.T_cyc + max(can.d_max - can.d_min, 0.0))) ** 2


def motor_speed_gains(A: np.ndarray, Q: np.ndarray, R_1: float) -> np.ndarray:
    """Stationary Kalman gains (n,) with the motor speed alone, the first state, whose variance is R_1.

    Raises:
        DesignError: there are none; shows the matrices.
    """
    H = np.eye(len(A))[:1]
    try:
        P = solve_discrete_are(A.T, H.T, Q, np.array([[R_1]]))
    except np.linalg.LinAlgError as error:
        raise DesignError(f"no stationary Kalman filter: {error}; A =\n{A}\nQ =\n{Q}\nR = {R_1:g}") from error
    return P[:, 0] / (P[0, 0] + R_1)


def message_gains(A: np.ndarray, Q: np.ndarray, R_1: float, R_2: float, T_age: float, cycle: int) -> np.ndarray:
    """Gains (n,) on a message in the periodic optimum; what it tells is omega_2, the second state, behind a lag.

    Args:
        R_1, R_2: variances of the motor speed and of a message.
        T_age: age of a message, the lag in s.
        cycle: of the messages, in samples.
    """
    n, share = len(A), min(T_S / T_age, 1.0)
    F, noise = np.zeros((n + 1, n + 1)), np.zeros((n + 1, n + 1))
    F[:n, :n], noise[:n, :n] = A, Q
    F[n, n], F[n, 1] = 1.0 - share, share
    H_1, H_2 = np.eye(n + 1)[0], np.eye(n + 1)[-1]
    P, L_2 = np.eye(n + 1), np.zeros(n + 1)
    for k in range(SAMPLES):
        P, _ = _measured(F @ P @ F.T + noise, H_1, R_1)
        if k % cycle == 0:
            P, L_2 = _measured(P, H_2, R_2)
    return L_2[:n]


def _measured(P: np.ndarray, H: np.ndarray, R: float) -> tuple[np.ndarray, np.ndarray]:
    """Covariance and gain after a scalar measurement H x with variance R."""
    L = P @ H / (H @ P @ H + R)
    return P - np.outer(L, H @ P), L
