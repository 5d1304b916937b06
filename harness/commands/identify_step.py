"""What `driveline identify --step` does with the recording of one tip-in."""

from collections.abc import Mapping
from importlib.metadata import version
from math import exp
from pathlib import Path
from typing import TYPE_CHECKING, Any

from toolground.errors import UserError

from .jobs import job
from .redesign import compared_in, redesign

if TYPE_CHECKING:
    from driverecords.measurement import Measurement

    from ..identification.step import Step

WIDEST = 0.5
"""Half of a 95 % interval, in the logarithm, up to which a parameter is one of a vehicle file."""


def run_step(args: Any, recording: "Measurement", vehicle: Mapping[str, Any], output: Path) -> int:
    """Identifies C and phi_B, says so, and writes them into a vehicle file.

    Raises:
        UserError: an option is not for a step.
        RecordingError: the recording has no step that can be used, or C is not known well enough.
    """
    if args.free or args.report:
        raise UserError(f"--step gives C and phi_B alone: leave {'--free' if args.free else '--report'} out")
    from driverecords.source import RecordingError
    from toolground.atomic_files import write_text

    from ...fmus.building.car_entries import vehicle_text
    from ...fmus.building.one_car import updated
    from ..identification.step import identify_step

    runs, same = compared_in(), args.distinguishing | {"vehicle": vehicle, "step": True}
    with job(args, output.with_suffix(".json"), same, {}, [output], args.read) as made:
        found = identify_step(recording, vehicle, runs)
        lines = [*_lines(found), *(f"warning: {each}" for each in recording.warnings)]
        for line in lines:
            args.say(line)
        if found.halves["C"] > WIDEST:
            raise RecordingError(f"{recording.name}: C is known to a factor of {exp(found.halves['C']):.2g} only")
        known = {name: float(f"{found.values[name]:.4g}") for name, half in found.halves.items() if half <= WIDEST}
        entries = updated(vehicle, known)
        head = f"The car of {args.recording.name}, by `driveline identify --step` (driveline-damping {{}})."
        text = vehicle_text([head.format(version("driveline-damping")), *lines], entries)
        made.begin()
        write_text(text, output)
        made.wrote(output)
        if args.design:
            made.wrote(*redesign(output, vehicle, runs, args.replace, args))
    return 0


def _lines(found: "Step") -> list[str]:
    """What was found, for people."""
    from ..identification.priors import PRIORS

    told: list[str] = []
    for name, value in found.values.items():
        half, unit = found.halves[name], PRIORS[name].unit
        answer = f" = {value:.4g} {unit}, 95 %:" if half <= WIDEST else f": not told, in {unit} it is anything from"
        told.append(f"{name}{answer} {value * exp(-half):.3g} to {value * exp(half):.3g}")
    if "phi_B" not in found.values:
        told.append("phi_B: not told, as the torque does not change its sign")
    return [
        *told,
        f"by {found.plant}, whose motor speed is off by {found.error:.2g} rad/s rms; before the step it is noisy by "
        f"{found.noise:.2g} rad/s",
    ]
