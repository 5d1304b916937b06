"""A torque when it acted, where a recording has it before or after the motor speed.

A logger takes its channels from different tasks and buses, each with a delay of its own. And a tool that steps motor
and car one after the other holds the torque meanwhile, so that the car gets it half a step earlier or later than it is
recorded. Both are a shift against the motor speed,

    T(t) = T_recorded(t + late)

Its means over the parts of a sample follow from a spline through the integral of the recorded ones, which without a
shift gives them again.
"""

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline

from .drive_train import STEPS

MOST = 0.006
"""Time in s by which a torque may be early or late at most."""


def integral(means: np.ndarray, T_s: float) -> BSpline:
    """Of a torque over the time in samples, in N.m; MOST beyond both ends it is held.

    Args:
        means: of each part of the samples in N.m, shape (n, STEPS).
        T_s: between samples in s.
    """
    beyond = int(np.ceil(STEPS * MOST / T_s))
    held = np.pad(means.ravel(), beyond, mode="edge")
    time = np.arange(-beyond, means.size + beyond + 1) / STEPS
    return make_interp_spline(time, np.concatenate([[0.0], np.cumsum(held)]) / STEPS, k=5)


def shifted(of: BSpline, first: int, last: int, late: float, derivative: int = 0) -> np.ndarray:
    """Means over the parts of the samples from first to last, without last, `late` samples later; or their derivative
    by `late`. Shape (samples, STEPS)."""
    edges = np.arange(STEPS * first, STEPS * last + 1) / STEPS + late
    return np.diff(of(edges, nu=derivative)).reshape(-1, STEPS) * STEPS
