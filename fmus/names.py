"""Names of the project's FMUs by their places in the loop, for those who need not import what these compute."""

from toolground.known_names import RENAMED

from ..models.controller import T_S as T_S
from ..models.physics.vehicle import CAR

T_MAX = CAR.T_max
"""Largest torque of the motor of the default car in N.m."""

COMPARATORS = ("NoDamping", "SpeedWashout", "SpeedDifference", "PaperObserver", "LinearObserver", "TrueMotion")
"""Controllers that ours is compared with, in the order of the tables."""

# the torque of the motor does not depend on its speed, so it is stepped first and then known over the step
PLACES: dict[str, tuple[str, ...]] = {
    "motor": ("MotorTorqueLoop",),
    "controller": ("DampingController", *COMPARATORS),
    "can": ("WheelSpeedCan",),
    "plant": ("TwoMassDriveline", "ValidationVehicle"),
}
"""The places of the loop in the order in which they step, and the FMUs for each, the first by default."""

RENAMED.update(
    {
        "like": "launch_tolerance",
        "grows": "swing_decay",
        "excuse": "demand_excuse",
        "apart": "wheel_deviation",
        "leap": "wheel_jump",
        "free": "launch_speed",
        "haste": "demand_lead",
        "bounce": "landing_share",
        "brake": "landing_brake",
        "PerfectState": "TrueMotion",
    }
)
# Parameters of the controllers, and one of these, that once had another name.
