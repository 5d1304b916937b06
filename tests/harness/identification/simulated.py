"""Test drives of the model that is identified: short, with noise as it assumes it, all parameters known."""

from dataclasses import replace

import numpy as np

from driveline.harness.identification.drive_train import STEPS, Parameters
from driveline.harness.identification.model_inputs import Drive
from driveline.harness.identification.prediction import Noise
from driveline.harness.identification.segment_simulation import Simulator
from driveline.harness.identification.torque_loop import TorqueLoop
from driveline.harness.manoeuvres.prbs import shift_register

T_S = 0.002
P = Parameters(J_1=0.055, J_2=0.3, C=117.4, d=0.3, phi_B=0.157, g_T=1.02, g_L=0.99)
NOISE = Noise(omega_1=0.15, T_mot=0.3, T_load=1.1)
SPEED = 129.0
"""In rad/s, of both masses at the beginning."""


def demand(n: int, mean: float = 10.0) -> np.ndarray:
    """In N.m, at n samples, as of `driveline record`."""
    bits = np.array(shift_register(n // 20 + 1), dtype=float)
    return mean + 30.0 * (2.0 * np.repeat(bits, 20)[:n] - 1.0)


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
        mean: motor torque in N.m; the load brakes as much.
        o_T, o_L: true less recorded motor and load torque, without their gain, in N.m.
    """
    T_mot = TorqueLoop(0.003).means(demand(n, mean), T_S, STEPS)
    time = np.arange(n * STEPS).reshape(n, STEPS) * T_S / STEPS
    T_load = -mean - 6.0 * np.sin(2.0 * np.pi * 0.7 * time) - 3.0 * np.sin(2.0 * np.pi * 5.0 * time)
    start = np.array([SPEED, SPEED, P.phi_B + T_mot[0, 0] / P.C, 0.0, 0.0])
    true = Drive(T_S, np.zeros(n + 1), T_mot, T_load)
    omega_1 = Simulator(n).run(true, 0, start, p._replace(g_T=1.0, g_L=1.0))[:, 0]
    white = np.random.default_rng(seed).standard_normal((3, n + 1))
    return replace(
        true,
        omega_1=np.concatenate([[SPEED], omega_1]) + noise.omega_1 * white[0],
        T_mot=p.g_T * (T_mot - o_T) + noise.T_mot * white[1, 1:, None],
        T_load=p.g_L * (T_load - o_L) + noise.T_load * white[2, 1:, None],
    )
