"""Free runs of an identified model over the end of its recording."""

from dataclasses import dataclass

import casadi as ca
import numpy as np

from ..recordings.measurement import Measurement
from .drive_train import Parameters, gear_torque
from .identify import UNMEASURED, WITHIN, Identified
from .prediction import filtered
from .quality import near_starts, segments


@dataclass(frozen=True, eq=False)
class FreeRuns:
    """Runs of `harness.identification.quality.SIMULATED`, each from the start that fits best, one behind the other
    with NaN between them, each of shape (n,).

    Attributes:
        time: in s, as recorded.
        omega_1, omega_2: speed of motor and wheels in rad/s.
        T_gear: in N.m.
        error: simulated less recorded motor speed in rad/s.
    """

    time: np.ndarray
    omega_1: np.ndarray
    omega_2: np.ndarray
    T_gear: np.ndarray
    error: np.ndarray


def free_runs(identified: Identified, recording: Measurement, stretch: float) -> FreeRuns:
    """
    Args:
        recording: from which it was identified.
        stretch: how much of its end in s.
    """
    drive, p = identified.drive, identified.p
    time, first = recording.time, max(len(drive) - round(stretch / drive.T_s), 0)
    pieces = segments(drive, (), UNMEASURED if recording.T_load is None else WITHIN, first)
    states, recorded = pieces.free_runs(p, near_starts(pieces, filtered(drive, p, identified.noise)))
    runs = []
    for first, x, omega_1 in zip(pieces.firsts, states, recorded, strict=True):
        at = slice(first + 1, first + 1 + pieces.length)
        runs.append(np.array([time[at], x[:, 0], x[:, 1], _gear_torque(x, p), x[:, 0] - omega_1]))
        runs.append(np.full((5, 1), np.nan))
    return FreeRuns(*np.hstack(runs))


def _gear_torque(x: np.ndarray, p: Parameters) -> np.ndarray:
    phi, dphi = ca.SX.sym("phi", len(x)), ca.SX.sym("dphi", len(x))
    T_gear = ca.Function("T_gear", [phi, dphi], [gear_torque(phi, dphi, p)])
    return np.asarray(T_gear(x[:, 2], x[:, 0] - x[:, 1])).ravel()
