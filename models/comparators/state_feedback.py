"""Linear state feedback: our damping law for a drive train without a gap.

    T_damp = -s/(s + omega_w) [k_d (omega_1 - omega_2) + k_T T_gear]

with the motion T_pred ahead. Without a gap there is nothing to land in.
"""

from ..controller import damping_law
from .fixed import fixed

NO_LANDING = dict.fromkeys(("T_gap", "landing_share", "landing_brake", "demand_lead", "omega_slow", "t_land"), 0.0) | {
    "t_return": 1.0
}

GAINS = {"k_d": 2.92, "k_T": 0.0157, "omega_w": 3.83, "T_pred": 0.00114}
"""Found by `driveline design --search`, see docs/calibration.md."""

LAW = fixed(damping_law, GAINS, phi_B=0.0, k_gap=1.0, **NO_LANDING)
