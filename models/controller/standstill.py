"""Rest: neither demand nor motion, for so long that the damping fades out and the estimator is held.

Sensor noise would otherwise rattle the motor of a standing car in its gap.
"""

from fmublocks.block.operators import clip, logical_and, minimum, where

from .supervision_interface import Parameters


def is_still(T_driver: float, omega_1: float, p: Parameters) -> bool:
    """Neither demand nor motion."""
    return logical_and(abs(T_driver) <= p.T_still, abs(omega_1) <= p.omega_still)


def longest(p: Parameters) -> float:
    """Time of stillness in s after which it is complete rest."""
    return p.t_rest + p.t_fade


def quiet_time(quiet: float, still: bool, T_s: float, p: Parameters) -> float:
    """Time in s without demand and motion, one sample later; counted no further than needed."""
    return where(still, minimum(quiet + T_s, 2.0 * longest(p)), 0.0)


def is_complete(quiet: float, p: Parameters) -> bool:
    """Whether it is complete rest, `quiet` s after the last demand or motion."""
    return quiet >= longest(p)


def is_seen(quiet: float, p: Parameters) -> bool:
    """Whether it was complete rest for as long again: a start without demand and motion is only taken for rest."""
    return quiet >= 2.0 * longest(p)


def remaining_damping(quiet: float, p: Parameters) -> float:
    """Share of the damping that is left, `quiet` s after the last demand or motion: 0 at complete rest."""
    return clip((longest(p) - quiet) / p.t_fade, 0.0, 1.0)
