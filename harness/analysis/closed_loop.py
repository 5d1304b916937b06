"""The damped drive train as a linear sampled system: its poles, while the teeth stay in contact.

Vehicle and wheels move as one here, without the damping by the tyre; the wheel speed is not used.
"""

from collections.abc import Mapping
from math import pi
from typing import NamedTuple

import numpy as np
from scipy.linalg import expm

from models.controller.supervision import T_S
from models.controller.torque_estimator import Estimate

from .kalman import transition
from .weights import Motor, Plant

STATES = Estimate._fields


class Mode(NamedTuple):
    """A pole: frequency in Hz, damping ratio (1 if it does not swing, negative if it grows)."""

    frequency: float
    damping_ratio: float


def sampled_drive_train(plant: Plant, motor: Motor) -> tuple[np.ndarray, np.ndarray]:
    """Matrices (5, 5) and (5,) over a sample: omega_1, omega_2, phi, T_mot, dT_mot, driven by a held T_ref."""
    wheels = plant.J_2 + plant.m * plant.r**2 / plant.i**2
    A = np.zeros((6, 6))
    A[0, 2:4] = -plant.C / plant.J_1, 1.0 / plant.J_1
    A[1, 2] = plant.C / wheels
    A[2, :2] = 1.0, -1.0
    A[3, 4] = 1.0
    A[4, 3:] = np.array([-1.0, -(2.0**0.5) * motor.tau, 1.0]) / motor.tau**2
    F = expm(A * T_S)
    return F[:5, :5], F[:5, 5]


def closed_loop(plant: Plant, motor: Motor, gains: Mapping[str, float]) -> np.ndarray:
    """Matrix (12, 12) of one sample of the loop: drive train, T_ref, estimate, last T_mot, washout."""
    F, G = sampled_drive_train(plant, motor)
    A, ahead = (transition(plant, gains["lambda_v"], h) for h in (T_S, gains["T_pred"]))
    pushed = {h: np.array([h, 0.0, 0.5 * h * h, 0.0]) / plant.J_1 for h in (T_S, gains["T_pred"])}
    L = np.array([gains[f"L_{state}"] for state in STATES])
    feedback = np.array([gains["k_d"], -gains["k_d"], gains["k_T"] * plant.C, 0.0])

    def sample(z: np.ndarray) -> np.ndarray:
        x, T_ref, e, T_last, washout = z[:5], z[5], z[6:10], z[10], z[11]
        T_mot = x[3]
        e = A @ e + pushed[T_S] * 0.5 * (T_last + T_mot)
        e = e + L * (x[0] - e[0])
        fed_back = feedback @ (ahead @ e + pushed[gains["T_pred"]] * T_mot)
        kept = washout + gains["omega_w"] * T_S * (fed_back - washout)
        return np.array([*(F @ x + G * T_ref), washout - fed_back, *e, T_mot, kept])

    return np.column_stack([sample(row) for row in np.eye(12)])


def modes(matrix: np.ndarray) -> list[Mode]:
    """The modes of a sampled system that swing."""
    rates = np.log([pole for pole in np.linalg.eigvals(matrix) if pole.imag > 0.0]) / T_S
    return [Mode(float(abs(s)) / (2.0 * pi), float(-s.real / abs(s))) for s in rates]


def swing(plant: Plant, motor: Motor, gains: Mapping[str, float]) -> tuple[Mode, Mode]:
    """The drive train without and with damping: its own mode, and the least damped one below twice its frequency."""
    undamped = closed_loop(plant, motor, dict(gains) | {"k_d": 0.0, "k_T": 0.0})
    alone = min(modes(undamped), key=lambda mode: abs(mode.damping_ratio))
    slow = (mode for mode in modes(closed_loop(plant, motor, gains)) if mode.frequency < 2.0 * alone.frequency)
    return alone, min(slow, key=lambda mode: mode.damping_ratio)
