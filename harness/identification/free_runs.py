"""Free runs of an identified model over the end of its recording."""

from dataclasses import dataclass

import casadi as ca
import numpy as np

from ..recordings.measurement import Measurement
from .drive_train import Parameters, gear_torque
from .identify import UNMEASURED, WITHIN, Identified
from .prediction import BURN_IN, filtered
from .quality import SIMULATED, near_starts, segments


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


def free_runs(identified: Identified, recording: Measurement, window: tuple[float, float]) -> FreeRuns:
    """
    Args:
        recording: from which it was identified.
        window: from and to when in s, as recorded, but for the first BURN_IN of the recording; the last run may
            end later.
    """
    drive, p, time = identified.drive, identified.p, recording.time
    begin, end = (round((t - time[0]) / drive.T_s) for t in window)
    length = round(SIMULATED / drive.T_s)
    span = -(-(end - begin) // length) * length
    last = min(max(begin + span, round(BURN_IN / drive.T_s) + length), len(drive))
    drift = UNMEASURED if recording.T_load is None else WITHIN
    pieces = segments(drive.between(0, last), (), drift, max(last - span, 0))
    states, recorded = pieces.free_runs(p, near_starts(pieces, filtered(drive, p, identified.noise)))
    runs = []
    for first, x, omega_1 in zip(pieces.firsts, states, recorded, strict=True):
        at = slice(first + 1, first + 1 + pieces.length)
        runs.append(np.array([time[at], x[:, 0], x[:, 1], _gear_torque(x, p), x[:, 0] - omega_1]))
        runs.append(np.full((5, 1), np.nan))
    return FreeRuns(*np.hstack(runs))


def end_of(recording: Measurement, stretch: float) -> tuple[float, float]:
    """From and to when in s the last `stretch` s are, or all of it."""
    return max(float(recording.time[-1]) - stretch, float(recording.time[0])), float(recording.time[-1])


def _gear_torque(x: np.ndarray, p: Parameters) -> np.ndarray:
    phi, dphi = ca.SX.sym("phi", len(x)), ca.SX.sym("dphi", len(x))
    T_gear = ca.Function("T_gear", [phi, dphi], [gear_torque(phi, dphi, p)])
    return np.asarray(T_gear(x[:, 2], x[:, 0] - x[:, 1])).ravel()
