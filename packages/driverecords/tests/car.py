"""A small car of the tests' own, excited by a binary torque: what its sensors would record without any error.

Motor and wheels on a shaft, the wheels on a tyre that slips in proportion to its force, and the vehicle:

    J_1 omega_1' = T_mot - T_gear    J_2 omega_2' = T_gear + T_load
    phi' = omega_1 - omega_2         T_gear = C phi + d phi'
    T_load = -k (omega_2 - omega_v)    J_v omega_v' = -T_load - T_0
"""

from functools import cache

import numpy as np
from scipy.signal import lsim, max_len_seq

RATIO, RADIUS = 9.0, 0.29
J_1, J_2, J_V, C, D, K, T_0 = 0.055, 0.3, 1.5, 117.4, 0.3, 30.0, 6.0


@cache
def drive(duration: float = 10.0, interval: float = 0.002) -> dict[str, np.ndarray]:
    """time, T_ref, T_mot, omega_1, omega_2 and T_load in SI units, motor side."""
    time = np.arange(round(duration / interval) + 1) * interval
    bits, _ = max_len_seq(9, length=round(duration / 0.04) + 2, taps=[4])
    demand = 10.0 + 30.0 * (2.0 * bits[(time / 0.04 + 1e-6).astype(int)] - 1.0)
    lag = 1.0 - np.exp(-interval / 0.003)
    T_mot = np.empty_like(demand)
    T_mot[0] = demand[0]
    for k in range(1, len(time)):
        T_mot[k] = T_mot[k - 1] + lag * (demand[k] - T_mot[k - 1])
    A = np.array(
        [
            [-D / J_1, D / J_1, 0.0, -C / J_1],
            [D / J_2, -(D + K) / J_2, K / J_2, C / J_2],
            [0.0, K / J_V, -K / J_V, 0.0],
            [1.0, -1.0, 0.0, 0.0],
        ]
    )
    B = np.array([[1.0 / J_1, 0.0], [0.0, 0.0], [0.0, -1.0 / J_V], [0.0, 0.0]])
    start = np.array([130.0, 130.0, 129.5, 0.1])
    _, x, _ = lsim(
        (A, B, np.eye(4), np.zeros((4, 2))), np.column_stack([T_mot, np.full_like(time, T_0)]), time, X0=start
    )
    omega_1, omega_2, omega_v, _ = np.asarray(x).T
    return {
        "time": time, "T_ref": demand, "T_mot": T_mot, "omega_1": omega_1, "omega_2": omega_2,
        "T_load": -K * (omega_2 - omega_v)
    }  # fmt: skip
