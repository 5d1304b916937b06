"""What a recording tells of a car of which something is known already."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from driverecords.measurement import Measurement
from fmuloop.argument_kinds import require_each, require_kind
from toolground.errors import UserError

from ..design.design_weights import records
from ..loop.built_fmus import built_together
from ..loop.places import NATIVE, PLANTS
from ..loop.settings import Settings
from .drive_train import Parameters, Vehicle
from .driven_plants import diagnose_driven, driven_plants
from .identify import Identified, Log
from .identify import identify as identified_from


def identify(
    recording: Measurement,
    vehicle: Mapping[str, Any] | None = None,
    more: Sequence[str] = (),
    log: Log = lambda _: None,
) -> Identified:
    """The parameters of the drive train from a recording of a test drive, with their covariance, how well they fit, and
    what may be wrong with the recording. It takes seconds.

        recording = driveline.read_measurement(Path("test_drive.csv"), i=9.0, r=0.29)
        identified = driveline.identify(recording)
        print(*driveline.identified_lines(identified), *identified.warnings, sep="\\n")

    Args:
        vehicle: entries of the vehicle file of the car as it is known, with which the search begins; what it does not
            name is that of the default car.
        more: names of parameters that are to be identified too; J_1.
        log: gets a line for each step.

    Raises:
        RecordingError: the recording is too short, or nothing moves in it.
        MissingExtra: the extra `identification` is not installed.
    """
    require_kind("recording", recording, Measurement, "a Measurement, as read_measurement reads it")
    require_each("more", more, str, "names of parameters")
    _, motor, _ = records(vehicle or {})
    identified = identified_from(recording, *known(vehicle or {}), motor.tau, more, log)
    if identified.explained or not identified.found.told_by("phi_B"):
        return identified
    log("driving both plants by the recorded torque, as the model does not explain the car")
    failed = None
    try:
        # the other build would take minutes
        settings = built_together(Settings(plant, build=NATIVE) for plant in PLANTS)[0]
        identified = replace(identified, plant_fit=driven_plants(identified, vehicle or {}, settings))
    except UserError as reason:
        failed = reason
    return replace(identified, warnings=(*identified.warnings, *diagnose_driven(identified, failed)))


def known(vehicle: Mapping[str, Any]) -> tuple[Parameters, Vehicle]:
    """With what the search begins, and what the tyre carries, by the entries of a vehicle file."""
    plant, _, _ = records(vehicle)
    ratio = plant.r / plant.i
    behind = Vehicle(plant.m * ratio**2, plant.d_low * ratio**2, plant.v_low / ratio)
    tyre = {"c_t": plant.c_slip / plant.sigma_s * ratio**2, "sigma_t": plant.sigma_s / ratio}
    return Parameters(plant.J_1, plant.J_2, plant.C, 0.0, plant.phi_B, **tyre), behind
