"""Active damping of the drive train by the motor (paper, Fig. 6): estimator and damping control.

The estimator (torque_estimator) is run once a sample, its estimate taken T_pred ahead, to when the
torque will act; the damping law (damping_law) adds to the driver's demand what opposes the twisting
motion and vanishes when stationary. Damping and landing together take no more than T_take_max from the
demand and add no more than T_add_max to it; modes fade within t_fade.

While the motor signals are not to be trusted, the driver's demand is passed through (fallback); a wheel speed
that is not only ends the mode that uses it. What counts as that, and how long, is in docs/control.md. At rest
(neither demand nor motion) the damping fades out and the estimator is held, until there is one or the other.
"""

from .controller import damping_law, torque_estimator
from .controller.supervised_controller import supervised

BLOCK = supervised(
    name="DampingController",
    description="Active damping of the drive train: nonlinear torque estimator and damping control",
    module=__name__,
    estimator=torque_estimator,
    law=damping_law,
)
