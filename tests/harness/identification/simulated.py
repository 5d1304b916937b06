"""Test drives of the model that is identified: short, with noise as it assumes it, all parameters known."""

from dataclasses import replace
from functools import cache

import casadi as ca
import numpy as np
from scipy.interpolate import make_interp_spline

from driveline.harness.identification.buffered import Buffered
from driveline.harness.identification.drive_train import STEPS, Parameters, State, Vehicle, sample, tyre_torque
from driveline.harness.identification.estimator import Found, search
from driveline.harness.identification.identify import FREE, WITH_LOAD, Identified, Quality
from driveline.harness.identification.model_inputs import Drive
from driveline.harness.identification.prediction import Noise, Predictor
from driveline.harness.identification.torque_loop import FittedLoop, TorqueLoop
from driveline.harness.identification.wheel_speed import LateWheelSpeed
from driveline.harness.manoeuvres.prbs import shift_register

T_S = 0.002
P = Parameters(J_1=0.055, J_2=0.3, C=117.4, d=0.1, phi_B=0.157, g_T=1.02, g_L=0.99, c_t=2900.0, sigma_t=1.55)
BEHIND = Vehicle(J_v=1.505, d_low=4.15, omega_low=15.5)
NOISE = Noise(omega_1=0.15, T_mot=0.3, T_load=1.1)
SPEED = 129.0
"""In rad/s, at the beginning."""

SPARE = 10
"""Samples before and after a drive, from which late ones are taken."""


def demand(n: int, mean: float = 10.0) -> np.ndarray:
    """In N.m, at n samples, as of `driveline record`."""
    bits = np.array(shift_register(n // 20 + 1), dtype=float)
    return mean + 30.0 * (2.0 * np.repeat(bits, 20)[:n] - 1.0)


@cache
def states(n: int, p: Parameters, mean: float) -> np.ndarray:
    """Motor torque, motor speed, wheel speed, twist and load torque without noise, shape (5, n + 1)."""
    T_mot = TorqueLoop(0.003).torque(demand(n + 1, mean), T_S)
    x, T, once = ca.SX.sym("x", len(State._fields)), ca.SX.sym("T", STEPS), ca.SX.sym("p", len(Parameters._fields))
    of = Parameters._make(ca.vertsplit(once))
    after = sample(State._make(ca.vertsplit(x)), T, ca.SX(T_S), of, BEHIND)
    seen = ca.vertcat(after.omega_1, after.omega_2, after.phi, -tyre_torque(after, BEHIND))
    run = Buffered(ca.Function("run", [x, T, once], [ca.vertcat(*after), seen]).mapaccum("runs", n))
    start = State(SPEED, SPEED, SPEED, p.phi_B + mean / p.C, mean, -mean, 0.0, 0.0)  # type: ignore[arg-type]
    torque = Drive(T_S, np.zeros(n + 1), T_mot, None).torque(0.0)
    values = np.array(p._replace(g_T=1.0, g_L=1.0), dtype=float)
    _, rest = run(np.array(start), torque.T, np.tile(values[:, None], (1, n)))
    first = np.array([[SPEED], [SPEED], [start.phi], [-mean]])
    return np.vstack([T_mot, np.hstack([first, rest])])


def simulated(
    seed: int,
    n: int = 1500,
    p: Parameters = P,
    noise: Noise = NOISE,
    o_T: float = 0.0,
    o_L: float = 0.0,
    mean: float = 10.0,
) -> Drive:
    """A drive of n samples.

    Args:
        p, noise: of the car and of its sensors.
        o_T: true less recorded motor torque, without its gain, o_L: recorded less true load torque, in N.m.
        mean: motor torque in N.m; the resistance is as much.
    """
    T_mot, omega_1, _, _, T_load = states(n + 2 * SPARE, p._replace(late_T=0.0, late_L=0.0), mean)
    at = np.arange(SPARE, SPARE + n + 1)

    def late(signal: np.ndarray, by: float) -> np.ndarray:
        return make_interp_spline(np.arange(len(signal)), signal, k=3)(at - by / T_S)

    white = np.random.default_rng(seed).standard_normal((3, n + 1))
    return Drive(
        T_S,
        omega_1[at] + noise.omega_1 * white[0],
        p.g_T * (late(T_mot, p.late_T) - o_T) + noise.T_mot * white[1],
        p.g_L * late(T_load, p.late_L) + o_L + noise.T_load * white[2],
    )


@cache
def predictor() -> Predictor:
    return Predictor(simulated(seed=1), NOISE, BEHIND)


@cache
def found() -> Found:
    """The search from the truth."""
    return search(predictor(), P, FREE, P, most=12)


LOOP = FittedLoop(
    TorqueLoop(0.0031234567, 1.01, 0.2, 0.0),
    dict.fromkeys(("tau", "gain", "offset", "delay"), 1e-5),
    0.3,
    0.99,
    np.zeros(1),
    np.zeros(1, bool),
)


def identified(**changes: float) -> Identified:
    """With warnings, a torque loop and a wheel speed.

    Args:
        changes: of what was found.
    """
    one = replace(found(), p=found().p._replace(**changes))
    quality = Quality(97.0, 92.0, 1.02, 0.98)
    return Identified(WITH_LOAD, one, predictor(), LOOP, LateWheelSpeed(0.035, 0.001), quality, ("something is odd",))
