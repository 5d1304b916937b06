"""The FMUs of the project."""

from importlib.metadata import version

from fmublocks.block.types import Block
from fmublocks.fmu import Fmu

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
from .names import COMPARATORS
from .origin import MODELS

_MODULES = (
    *(two_mass_driveline, validation_vehicle, motor_torque_loop, wheel_speed_can, damping_controller),
    *(no_damping, speed_washout, speed_difference, paper_observer, linear_observer, true_motion),
)

AUTHOR = "the driveline-damping authors"

ABOUT = {
    "version": version("driveline-damping"),
    "author": AUTHOR,
    "copyright": f"Copyright (c) 2026, {AUTHOR}",
    "license": "BSD-3-Clause, see documentation/licenses/license.txt",
}
"""Attributes of their descriptions."""


def _fmu(block: Block, stop_time: float = 10.0) -> Fmu:
    return Fmu(block, stop_time, about=ABOUT, sources=MODELS)


EVERY: dict[str, Fmu] = {
    module.BLOCK.name: _fmu(module.BLOCK, 2.0 if module is motor_torque_loop else 10.0) for module in _MODULES
}
"""By name, in the order in which they are built; the comparators, which are no part of the product, come last."""

FMUS: dict[str, Fmu] = {name: fmu for name, fmu in EVERY.items() if name not in COMPARATORS}
"""Those that are built when none is asked for by name."""

CONTROLLERS: dict[str, Fmu] = {name: fmu for name, fmu in EVERY.items() if "T_driver" in fmu.block.Input._fields}
"""Those that take the driver's demand."""

MANOEUVRE = _fmu(manoeuvre.BLOCK)
"""What `driveline ssp` drives the loop with in other tools."""

SIGNAL_FAULTS = _fmu(signal_faults.BLOCK)
"""What `driveline faults` puts between the sensors and the controller."""
