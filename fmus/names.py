"""Names of the project's FMUs by their places in the loop, for those who need not import what these compute."""

from collections.abc import Iterable
from difflib import get_close_matches

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

RENAMED = {
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
"""Parameters of the controllers, and one of these, that once had another name."""


def meant(name: str, known: Iterable[str]) -> str:
    """What to say of an unknown name, for example "did you mean tipin15 or tipin50?": the known ones nearest to it; of
    a variable without its instance those of all instances. Empty: none is near."""
    names = list(known)
    if RENAMED.get(name) in names:
        return f"it is called {RENAMED[name]} now"
    by_folded = {candidate.casefold(): candidate for candidate in names}
    near = [by_folded[match] for match in get_close_matches(name.casefold(), by_folded, n=3)]
    close = [candidate for candidate in names if candidate.rpartition(".")[2] == name] or near
    return f"did you mean {' or '.join(close)}?" if close else ""
