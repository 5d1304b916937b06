"""Damping law: what is added to the driver's demand, given the estimated motion of the drive train.

    T_damp = -s/(s + omega_w) [k_d (omega_1 - omega_2) + k_T T_gear],   k_d times k_gap in the gap

and, while the estimated twist is in the gap but for at most t_land, a demand limited to T_land.
"""

from typing import Any

from ..block.operators import clip, logical_and, minimum, where
from .torque_estimator import Estimate, gear_torque


def in_gap(e: Estimate, p: Any) -> Any:
    return abs(e.phi) < p.phi_B


def motion(e: Estimate, p: Any) -> Any:
    """The torque in N.m that the washout leaves the changing part of."""
    k_d = p.k_d * where(in_gap(e, p), p.k_gap, 1.0)
    return k_d * (e.omega_1 - e.omega_2) + p.k_T * gear_torque(e, p)


def washed_out(stationary: Any, value: Any, T_s: float, p: Any) -> Any:
    """The stationary part of `value` at the next sample."""
    return stationary + minimum(p.omega_w * T_s, 1.0) * (value - stationary)


def soft_landing(T_driver: Any, landing: Any, p: Any) -> Any:
    """The demand, limited while the teeth are between the flanks, `landing` s after they left one."""
    soft = logical_and(landing > 0.0, landing <= p.t_land)
    return where(soft, clip(T_driver, -p.T_land, p.T_land), T_driver)


def is_still(T_driver: Any, omega_1: Any, p: Any) -> Any:
    """Neither demand nor motion."""
    return logical_and(abs(T_driver) <= p.T_rest, abs(omega_1) <= p.omega_rest)


def resting(quiet: Any, p: Any) -> Any:
    """From 0 to 1 as the damping fades out at rest, `quiet` s after the last demand or motion.

    Written so that it is exactly 1 when quiet is t_rest + t_fade, whatever the rounding.
    """
    return clip(1.0 - (p.t_rest + p.t_fade - quiet) / p.t_fade, 0.0, 1.0)
