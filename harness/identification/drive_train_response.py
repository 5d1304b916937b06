"""Frequency response of the drive train in contact, from the motor torque to the motor speed.

With the load torque measured, the model has a rolling tyre with a vehicle behind it. About a speed it is a spring, its
carcass, in series with a damper, its slip, between the wheels and the inertia of the vehicle. A model identified
without the load torque has the vehicle in J_2 and ends there.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import minimize_scalar

from .drive_train import Parameters, Vehicle

FREQUENCIES = np.linspace(1.0, 20.0, 951)
"""In Hz, of figures; peaks are narrow."""

PEAK = (3.0, 20.0)
"""Frequencies in Hz between which the resonance is looked for."""


@dataclass(frozen=True)
class Tyre:
    """Attributes:
    c_t: stiffness in N.m/rad, motor side.
    d_t: torque over speed of slip in N.m.s/rad, motor side.
    J_v: inertia of the vehicle in kg.m2, motor side.
    """

    c_t: float
    d_t: float
    J_v: float


def rolling_tyre(p: Parameters, behind: Vehicle, omega: float) -> Tyre:
    """That of the model, at a motor speed in rad/s."""
    return Tyre(p.c_t, p.c_t * p.sigma_t / max(omega, 1.0), behind.J_v)


def response(p: Parameters, frequencies: np.ndarray, behind: Tyre | None = None) -> np.ndarray:
    """omega_1/T_mot in rad/s per N.m, complex, at frequencies in Hz, teeth in contact."""
    s = 2j * np.pi * frequencies
    wheels = p.J_2 * s
    if behind:
        joint = 1.0 / (s / behind.c_t + 1.0 / behind.d_t)
        wheels = wheels + joint * behind.J_v * s / (joint + behind.J_v * s)
    shaft = p.C / s + p.d
    return 1.0 / (p.J_1 * s + shaft * wheels / (shaft + wheels))


def resonance(p: Parameters, behind: Tyre | None = None) -> float:
    """Frequency in Hz at which the response is largest."""
    coarse = np.linspace(*PEAK, 341)
    near = float(coarse[int(np.argmax(abs(response(p, coarse, behind))))])

    def minus(f: float) -> float:
        return -float(abs(response(p, np.array([f]), behind))[0])

    peak: Any = minimize_scalar(minus, bounds=(near - 0.1, near + 0.1), method="bounded")
    return float(peak.x)
