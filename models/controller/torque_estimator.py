"""Estimator of the gear torque: the paper's third-order nonlinear Kalman filter (section V).

    J_1 domega_1/dt = T_mot - T_gear
    J_2 domega_2/dt = T_l + (1 - lambda) T_gear
           dphi/dt  = omega_1 - omega_2          T_gear = C b(phi, phi_B)

The vehicle takes the share lambda of the gear torque; T_l is the rest of the load, a slow state.
With lambda = 0 and no gain on T_l this is literally the paper's observer. Between samples the
model is integrated by the leapfrog method. The measured motor speed corrects it at every sample,
the wheel speed when a message arrives, against the estimate of T_age before: so old is the message.
The constant gains come from a Riccati equation (harness, controller design), one set for
each mode; `share` blends from the set without (0) to the set with the wheel speed (1).
"""

from typing import Any, NamedTuple

from ..backlash import dead_zone
from ..block.operators import clip, interpolate, where

HISTORY = 32
"""Past estimates of omega_2 that are kept, one a sample."""


class Estimate(NamedTuple):
    """State of the estimator, motor side: speeds (rad/s), twist (rad), load torque (N.m)."""

    omega_1: Any
    omega_2: Any
    phi: Any
    T_l: Any


def gear_torque(e: Estimate, p: Any) -> Any:
    return p.C * dead_zone(e.phi, p.phi_B)


def at_rest_with(omega_1: Any, T_mot: Any, p: Any) -> Estimate:
    """Estimate before anything was measured: no twisting motion, the whole motor torque in the gear."""
    flank = where(T_mot > 0.0, p.phi_B, where(T_mot < 0.0, -p.phi_B, 0.0))
    return Estimate(omega_1, omega_1, T_mot / p.C + flank, 0.0)


def predict(e: Estimate, T_mot: Any, h: Any, p: Any) -> Estimate:
    """The estimate h seconds later under the motor torque T_mot."""
    phi = e.phi + 0.5 * h * (e.omega_1 - e.omega_2)
    T_gear = p.C * dead_zone(phi, p.phi_B)
    omega_1 = e.omega_1 + h * (T_mot - T_gear) / p.J_1
    omega_2 = e.omega_2 + h * (e.T_l + (1.0 - p.lambda_v) * T_gear) / p.J_2
    return Estimate(omega_1, omega_2, phi + 0.5 * h * (omega_1 - omega_2), e.T_l)


def correct_by_motor_speed(e: Estimate, omega_1_meas: Any, share: Any, p: Any) -> Estimate:
    error = omega_1_meas - e.omega_1
    return Estimate(
        e.omega_1 + error * (p.L_omega_1 + share * (p.Lw_omega_1 - p.L_omega_1)),
        e.omega_2 + error * (p.L_omega_2 + share * (p.Lw_omega_2 - p.L_omega_2)),
        e.phi + error * (p.L_phi + share * (p.Lw_phi - p.L_phi)),
        e.T_l + error * (p.L_T_l + share * (p.Lw_T_l - p.L_T_l)),
    )


def correct_by_wheel_speed(
    e: Estimate, omega_2_can: Any, past: tuple[Any, ...], samples: Any, share: Any, p: Any
) -> Estimate:
    """Correction by a message that is `samples` samples old; past[k] is the estimate k + 1 samples ago."""
    error = share * (omega_2_can - interpolate(past, samples - 1.0))
    return Estimate(
        e.omega_1 + error * p.L_can_omega_1,
        e.omega_2 + error * p.L_can_omega_2,
        e.phi + error * p.L_can_phi,
        e.T_l + error * p.L_can_T_l,
    )


def bounded(e: Estimate, p: Any) -> Estimate:
    """The estimate within what the drive train can bear, whatever was measured."""
    phi_max = p.phi_B + 4.0 * p.T_max / p.C
    return Estimate(
        clip(e.omega_1, -p.omega_max, p.omega_max),
        clip(e.omega_2, -p.omega_max, p.omega_max),
        clip(e.phi, -phi_max, phi_max),
        clip(e.T_l, -4.0 * p.T_max, 4.0 * p.T_max),
    )
