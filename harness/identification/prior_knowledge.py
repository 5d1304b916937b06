"""What a recording tells of a car of which something is known already."""

from collections.abc import Mapping, Sequence
from typing import Any

from ..base.argument_kinds import require_each, require_kind
from ..design.design_weights import records
from ..recordings.measurement import Measurement
from .drive_train import Parameters
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
        more: names of parameters that are to be identified too, of J_1, d and g_T.
        log: gets a line for each step.

    Raises:
        RecordingError: the recording is too short, or nothing moves in it.
        MissingExtra: the extra `identification` is not installed.
    """
    require_kind("recording", recording, Measurement, "a Measurement, as read_measurement reads it")
    require_each("more", more, str, "names of parameters")
    plant, motor, _ = records(vehicle or {})
    start = Parameters(plant.J_1, plant.J_2, plant.C, 0.0, plant.phi_B)
    return identified_from(recording, start, motor.tau, plant.m * plant.r**2 / plant.i**2, more, log)
