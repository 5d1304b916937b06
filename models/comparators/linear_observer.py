"""Linear observer without backlash and state feedback: our estimator and law for a drive train without a gap.

J_1 domega_1/dt = T_mot - T_gear
J_2 domega_2/dt = T_l + (1 - lambda_v) T_gear
       dphi/dt  = omega_1 - omega_2          T_gear = C phi

T_damp = -s/(s + omega_w) [k_d (omega_1 - omega_2) + k_T T_gear]
"""

from ..controller import torque_estimator
from ..controller.supervised_controller import supervised
from . import state_feedback
from .fixed import NOT_LEARNED, fixed

BLOCK = supervised(
    name="LinearObserver",
    description="Comparator: damping by state feedback behind a linear observer without backlash",
    module=__name__,
    estimator=fixed(torque_estimator, phi_B=0.0, **NOT_LEARNED),
    law=state_feedback,
)
