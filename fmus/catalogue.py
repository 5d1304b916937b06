"""The FMUs of the project, and with them those of the comparators."""

from . import damping_controller, motor_torque_loop, two_mass_driveline, validation_vehicle, wheel_speed_can
from .comparators import COMPARATORS
from .fmu import Fmu

FMUS: dict[str, Fmu] = {
    module.FMU.name: module.FMU
    for module in (
        two_mass_driveline,
        validation_vehicle,
        motor_torque_loop,
        wheel_speed_can,
        damping_controller,
    )
}
"""By name, in the order in which they are built."""

EVERY: dict[str, Fmu] = FMUS | COMPARATORS
"""Those too that are built only when they are asked for by name."""
