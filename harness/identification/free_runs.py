"""Free runs of an identified model, driven by the motor torque alone."""

from functools import cache

import casadi as ca
import numpy as np

from .buffered import Buffered
from .drive_train import STEPS, Parameters, State, Vehicle, gear_torque, sample, tyre_torque
from .prediction import BURN_IN, Predictor

SIMULATED = 0.5
"""Length of a run in s."""

RESULTS = ("omega_1", "omega_2", "T_gear", "T_load")
"""What a run gives."""


def free_runs(predictor: Predictor, p: Parameters, states: np.ndarray, first: int) -> tuple[np.ndarray, np.ndarray]:
    """Runs over SIMULATED, one behind the other to the end of each piece, each from the state of the filter.

    Args:
        states: of the filter after each sample, shape (n, states).
        first: sample with which the first run begins; its state is known by then.

    Returns:
        Samples of the recording that the runs have, shape (runs, n), and RESULTS there in rad/s and N.m, shape
        (runs, n, 4).
    """
    drive = predictor.drive
    n = round(SIMULATED / drive.T_s)
    torque = drive.torque(p.late_T)
    once = np.array([*p, *predictor.behind, drive.T_s], dtype=float)
    burn = round(BURN_IN / drive.T_s)
    begins = [(max(first, start + burn if start else 1), last - n + 1) for start, last in drive.pieces]
    firsts = np.concatenate([np.arange(begin, end, n) for begin, end in begins])
    runs = [_run(n)(states[at - 1], torque[at : at + n].T, np.tile(once[:, None], (1, n)))[1].T.copy() for at in firsts]
    return firsts[:, None] + np.arange(1, n + 1), np.array(runs)


@cache
def _run(n: int) -> Buffered:
    """The model alone over n samples."""
    x, T_mot = ca.SX.sym("x", len(State._fields)), ca.SX.sym("T_mot", STEPS)
    once = ca.SX.sym("once", len(Parameters._fields) + len(Vehicle._fields) + 1)
    *values, J_v, d_low, omega_low, T_s = ca.vertsplit(once)
    p, behind = Parameters._make(values), Vehicle._make((J_v, d_low, omega_low))
    after = sample(State._make(ca.vertsplit(x)), T_mot, T_s, p, behind)
    T_gear = gear_torque(after.phi, after.omega_1 - after.omega_2, p)
    results = ca.vertcat(after.omega_1, after.omega_2, T_gear, -tyre_torque(after, behind))
    return Buffered(ca.Function("sample", [x, T_mot, once], [ca.vertcat(*after), results]).mapaccum("run", n))
