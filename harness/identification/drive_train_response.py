"""Frequency response of the drive train in contact, from the motor torque to the motor speed.

With the load torque measured, the model ends at the wheels. What hangs on them is needed to say how the car answers
on its own: a rolling tyre, which is a spring, its carcass, in series with a damper, its slip, between the wheels and
the inertia of the vehicle,

    omega_2 - omega_v = -(dT_load/dt/c_t + T_load/d_t),   J_v domega_v/dt = -T_load

fitted to the load torque and the wheel speed of the filter. J_v = m r^2/i^2 is known. A model identified without the
load torque has the vehicle in J_2 and ends there.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.signal import csd

from .drive_train import Parameters

FREQUENCIES = np.linspace(1.0, 20.0, 191)
"""In Hz, of figures and tables."""

PEAK = (3.0, 20.0)
"""Frequencies in Hz between which the resonance is looked for."""

TYRE = (2.0, 12.0)
"""Frequencies in Hz at which the tyre is fitted: below, road and air act on the vehicle as well."""

WINDOW = 1024
"""Samples of a window of the spectra."""


@dataclass(frozen=True)
class Tyre:
    """Attributes:
    c_t: stiffness in N.m/rad, motor side.
    d_t: torque over speed of slip in N.m.s/rad, motor side.
    J_v: inertia of the vehicle in kg.m2, motor side.
    explained: share of the power of the load torque.
    """

    c_t: float
    d_t: float
    J_v: float
    explained: float


def tyre(T_load: np.ndarray, omega_2: np.ndarray, T_mot: np.ndarray, T_s: float, J_v: float) -> Tyre:
    """By the spectra with the motor torque, so that the noise of the others, which it does not know, falls out.

    Args:
        T_load, T_mot: load and motor torque in N.m, shape (n,).
        omega_2: speed of the wheels in rad/s, shape (n,).
        T_s: between samples in s.
        J_v: inertia of the vehicle in kg.m2, motor side.
    """
    length = min(WINDOW, len(T_mot))
    (f, load), (_, wheel) = (csd(T_mot, x, 1.0 / T_s, nperseg=length, detrend="linear") for x in (T_load, omega_2))
    at = (f >= TYRE[0]) & (f <= TYRE[1])
    s, load, wheel = 2j * np.pi * f[at], load[at], wheel[at]
    # (omega_2 - omega_v)/-T_load = s/c_t + 1/d_t
    gives = -(wheel / load + 1.0 / (J_v * s))
    weight = abs(load)
    A = np.concatenate([np.column_stack([0.0 * weight, weight]), np.column_stack([weight * s.imag, 0.0 * weight])])
    b = np.concatenate([weight * gives.real, weight * gives.imag])
    spring, slip = np.linalg.lstsq(A, b, rcond=None)[0]
    missed = gives - spring * s - slip
    explained = 1.0 - float(np.sum(abs(weight * missed) ** 2) / np.sum(abs(weight * gives) ** 2))
    return Tyre(1.0 / float(spring), 1.0 / float(slip), J_v, explained)


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

    found: Any = minimize_scalar(minus, bounds=(near - 0.1, near + 0.1), method="bounded")
    return float(found.x)
