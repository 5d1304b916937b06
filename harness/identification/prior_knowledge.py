"""What a recording tells of a car of which something is known already."""

from collections.abc import Mapping, Sequence
from typing import Any

from ..design.design_weights import records
from ..recordings.measurement import Measurement
from .drive_train import Parameters
from .identify import Identified, Log, identify


def identified(
    recording: Measurement,
    vehicle: Mapping[str, Any] | None = None,
    more: Sequence[str] = (),
    log: Log = lambda _: None,
) -> Identified:
    """
    Args:
        vehicle: entries of the vehicle file of the car as it is known, with which the search begins; what it does not
            name is that of the default car.
        more, log: see `harness.identification.identify.identify`, as are the errors.
    """
    plant, motor, _ = records(vehicle or {})
    start = Parameters(plant.J_1, plant.J_2, plant.C, 0.0, plant.phi_B)
    return identify(recording, start, motor.tau, plant.m * plant.r**2 / plant.i**2, more, log)
