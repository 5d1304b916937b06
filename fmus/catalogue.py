"""The FMUs of the project."""

from ..models import (
    damping_controller,
    manoeuvre,
    motor_torque_loop,
    signal_faults,
    two_mass_driveline,
    validation_vehicle,
    wheel_speed_can,
)
from ..models.comparators import (
    linear_observer,
    no_damping,
    paper_observer,
    speed_difference,
    speed_washout,
    true_motion,
)
from .fmu import Fmu
from .names import COMPARATORS

_MODULES = (
    *(two_mass_driveline, validation_vehicle, motor_torque_loop, wheel_speed_can, damping_controller),
    *(no_damping, speed_washout, speed_difference, paper_observer, linear_observer, true_motion),
)

EVERY: dict[str, Fmu] = {
    module.BLOCK.name: Fmu(module.BLOCK, stop_time=2.0 if module is motor_torque_loop else 10.0) for module in _MODULES
}
"""By name, in the order in which they are built; the comparators, which are no part of the product, come last."""

FMUS: dict[str, Fmu] = {name: fmu for name, fmu in EVERY.items() if name not in COMPARATORS}
"""Those that are built when none is asked for by name."""

MANOEUVRE = Fmu(manoeuvre.BLOCK, stop_time=10.0)
"""What `driveline ssp` drives the loop with in other tools."""

SIGNAL_FAULTS = Fmu(signal_faults.BLOCK, stop_time=10.0)
"""What `driveline faults` puts between the sensors and the controller."""
