"""Fatigue of the gear by counting the cycles of its torque."""

from types import ModuleType

import numpy as np

from toolground.optional_packages import required

from .declaration import Absent

EXPONENT = 5.0
"""Slope of the assumed fatigue line."""


def require_counting() -> ModuleType:
    """The package rainflow.

    Raises:
        MissingExtra: it is not installed.
    """
    return required("rainflow", "counting load cycles", "driveline-damping[replay]")


def damage(T_gear: np.ndarray) -> float:
    """Sum of count * range^5 over the rainflow cycles of T_gear (ASTM E1049; half cycles count 0.5).

    In (N.m)^5, of use only relative to another run.

    Raises:
        MissingExtra: the package rainflow is not installed.
        Absent: the torque is not finite.
    """
    if not np.isfinite(T_gear).all():
        raise Absent("the gear torque is not finite")
    cycles = require_counting().count_cycles(T_gear)
    return float(sum(count * swing**EXPONENT for swing, count in cycles))
