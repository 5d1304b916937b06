"""By how much the wheel speed is late: the fit does not use it, since its messages come when they come. But the filter
knows the speed of the wheels, with which they are compared."""

from typing import NamedTuple

import numpy as np

EARLIEST, LATEST = -0.02, 0.12
"""Delays in s that are looked at: none, to that of a slow unit on a full bus."""


class LateWheelSpeed(NamedTuple):
    """Mean age of the recorded wheel speed.

    Attributes:
        time: in s, negative if it is early.
        deviation: its standard deviation in s, as quarters of the recording scatter.
    """

    time: float
    deviation: float


def late_wheel_speed(
    recorded: np.ndarray, valid: np.ndarray | None, omega_2: np.ndarray, T_s: float
) -> LateWheelSpeed | None:
    """The shift with which the recorded speed follows that of the filter best; None where it lies at the edge of what
    is looked at.

    Args:
        recorded: in rad/s, motor side, shape (n + 1,).
        valid: whether it is; None: always.
        omega_2: of the filter from the second sample on in rad/s, shape (n,).
    """
    first, last = round(EARLIEST / T_s), round(LATEST / T_s)
    at = np.arange(last, len(omega_2) + first)
    y = recorded[1:][at]
    use = np.ones(len(at), bool) if valid is None else valid[1:][at]
    if use.sum() < 10 * (last - first):
        return None
    shifts = np.arange(first, last + 1)
    errors = np.array([np.where(use, y - omega_2[at - shift], 0.0) ** 2 for shift in shifts])
    whole = _lowest(errors.sum(axis=1), shifts)
    parts = [_lowest(part.sum(axis=1), shifts) for part in np.array_split(errors, 4, axis=1)]
    if whole is None or None in parts:
        return None
    return LateWheelSpeed(whole * T_s, float(np.std(np.array(parts), ddof=1)) * T_s / 2.0)


def _lowest(errors: np.ndarray, shifts: np.ndarray) -> float | None:
    """Where a parabola through the lowest value and its neighbours is lowest."""
    k = int(np.argmin(errors))
    if k in (0, len(errors) - 1):
        return None
    before, least, after = errors[k - 1 : k + 2]
    return float(shifts[k] + 0.5 * (before - after) / (before - 2.0 * least + after))
