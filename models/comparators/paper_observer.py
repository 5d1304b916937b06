"""The paper's observer taken literally, and the imperfect derivative of its gear torque (Sugiura and Hori 1996).

    J_1 domega_1/dt = T_mot - T_gear
    J_2 domega_2/dt = T_gear
           dphi/dt  = omega_1 - omega_2          T_gear = C b(phi, phi_B)

    T_damp = -k_T s/(s + omega_w) T_gear

The vehicle takes no share of the gear torque, nor is there a load.
"""

from ..controller import torque_estimator
from ..controller.supervised_controller import supervised
from . import state_feedback
from .fixed import NOT_LEARNED, fixed

GAINS = {
    "L_omega_1": 0.299725,
    "L_omega_2": 0.131277,
    "L_phi": -0.00690267,
    "L_can_omega_1": 0.000766178,
    "L_can_omega_2": 0.00415915,
    "L_can_phi": -7.25991e-05,
}
"""Of the Riccati equations that ours come from, for this model (harness.design.design, literal_observer)."""

NO_SLIP = {"slip_drift": 100.0, "slip_load": 4.0, "t_drift": 1.0, "t_grip": 1.0} | dict.fromkeys(
    ("Ls_omega_1", "Ls_omega_2", "Ls_phi", "Ls_T_l"), 0.0
)
"""Slip is never seen, and there are no gains for it."""

BLOCK = supervised(
    name="PaperObserver",
    description="Comparator: damping by the derivative of the gear torque that the paper's observer estimates",
    module=__name__,
    estimator=fixed(torque_estimator, GAINS, lambda_v=0.0, L_T_l=0.0, L_can_T_l=0.0, **NO_SLIP, **NOT_LEARNED),
    law=fixed(state_feedback, {"k_T": 4.45, "omega_w": 299.0}, k_d=0.0, T_pred=0.0),
)
