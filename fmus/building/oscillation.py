"""How the drive train of a plant swings while its teeth touch, by the linearised equations of the plant."""

from math import pi
from typing import Any, NamedTuple

import numpy as np

from fmublocks.block.types import ContinuousBlock

SPEED = 15.0 / 3.6
"""In m/s, at which frequency and damping ratio of a car are given: slow, where tyres damp little."""

SHARE = 0.05
"""Of the load on the driven wheels, which their tyres pull there: far from sliding."""

DRY_AND_SMOOTH = {"recorded_load": False, "mu": 1.0, "r_6a": 0.0, "r_6b": 0.0, "r_12a": 0.0, "r_12b": 0.0}
"""Road and motor there; the ripple is a disturbance, no stiffness over the angle of the rotor."""

STEP = 1e-6
"""By which each state is moved to either side, in its unit: less than the teeth are pressed together."""


class Mode(NamedTuple):
    """A pole: frequency in Hz, damping ratio (1 if it does not swing, negative if it grows)."""

    frequency: float
    damping_ratio: float


def mode(s: complex) -> Mode:
    """That of a pole in 1/s."""
    return Mode(float(abs(s)) / (2.0 * pi), float(-s.real / abs(s)))


def oscillation(plant: ContinuousBlock, p: Any) -> Mode:
    """The mode of the plant alone in which a torque of the motor shows most in its speed, rolling on a level road.

    Args:
        p: the parameters of the plant.
    """
    T = rolling_torque(p)
    here = {"v_0": SPEED, "T_0": T, **DRY_AND_SMOOTH}
    p = p._replace(**{name: value for name, value in here.items() if name in p._fields})
    u = plant.Input(T_mot=T)
    start = plant.start(u, p)

    def rates(x: np.ndarray, T_mot: float = T) -> np.ndarray:
        return np.array(plant.derivative(plant.State(*x.tolist()), u._replace(T_mot=T_mot), p))

    x = np.array(start)
    moves = STEP * np.eye(len(x))
    A = np.column_stack([(rates(x + dx) - rates(x - dx)) / (2.0 * STEP) for dx in moves])
    B = rates(x, T + 0.5) - rates(x, T - 0.5)
    acts = A.any(axis=0)  # angles of the rotor and the like act on nothing
    poles, vectors = np.linalg.eig(A[np.ix_(acts, acts)])
    speed = list(np.flatnonzero(acts)).index(start._fields.index("omega_1"))
    shown = vectors[speed] * np.linalg.solve(vectors, B[acts])
    return mode(poles[np.argmax(np.where(np.imag(poles) > 0.0, abs(shown), -1.0))])


def rolling_torque(p: Any) -> float:
    """Torque in N.m of the motor there."""
    return _friction(p) + SHARE * getattr(p, "F_z0", p.m * p.g) * p.r / p.i


def _friction(p: Any) -> float:
    """Torque in N.m of the motor that what rubs between motor and wheels takes; the design model has none."""
    if "c_fm" not in p._fields:
        return 0.0
    return p.c_fm + (p.c_fg + p.v_fg * SPEED / p.r) / p.i
