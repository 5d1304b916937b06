"""Identifies the drive train from a recording of a test drive: the inertia of the wheels J_2, the stiffness C and half
the gap phi_B, each with its 95 % interval, the lag of motor control where the torque demand was recorded, and
damping, tyre and the time by which each channel is recorded late. Written are the vehicle file, which other commands
take as --vehicle, beside it all that was found (NAME_identified.json), what made it (NAME.json) and a figure.

The recording is a file with the columns

  {columns}

under any name that docs/recordings.md lists. It finds more with {more}. Without load torque J_2 carries the vehicle,
and the result is called effective. The fit is judged on the last quarter, with parameters found without it. What is
likely to be wrong with the recording, or is not told by it, is said. A stiffness that is known to no better than
+- 50 % makes no vehicle file, and a gap that is known no better stays as it was; docs/identification.md tells more.

With --step the recording of one tip-in or let-off without control is enough, for C and, if the torque changes its
sign, phi_B: what else is known of the car is that of the vehicle file.

examples:
  driveline record && driveline identify results/record/TwoMassDriveline_prbs_off.csv --output car.toml
  driveline identify drive.mf4 --vehicle examples/cars/van.toml --output my_van.toml
  driveline identify drive.csv --free J_1 --column T_mot='M_em [Nm]'
  driveline identify drive.blf --dbc drive_train.dbc --design
  driveline identify tip_in.csv --step --vehicle data_sheet.toml --output car.toml
"""

import json
from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from driverecords.arguments import examples, recording
from toolground.argument_types import written
from toolground.arguments import option, record
from toolground.optional_packages import required
from toolground.printing import Printing

from .identify_step import run_step
from .jobs import job
from .options import Figures, Replacing, Report, file_of
from .recorded import Recorded

if TYPE_CHECKING:
    from driverecords.measurement import Measurement

    from ..identification.identify import Identified
    from ..views.figure_options import FigureOptions

FREE = ("J_1",)

IN_HELP = {
    "columns": ", ".join(examples("time", "T_mot", "omega_1", "omega_wheel")),
    "more": " and ".join(examples("T_wheel", "T_ref")),
}


@record
class Arguments(Recorded, Figures, Replacing, Report, Printing):
    recording: Path = recording("the recorded test drive")
    vehicle: Path | None = file_of("what is known of the car (default: that of all blocks)")
    free: tuple[str, ...] = option((), "identify this too", choices=FREE)
    output: Path | None = option(
        None,
        "the vehicle file (default: results/identify/RECORDING_car.toml)",
        written(".toml", "a vehicle file"),
        metavar="FILE.toml",
    )
    step: bool = option(False, "identify C and phi_B from one step of the torque")
    design: bool = option(False, "compute gains for this car, build the controller, compare on both plants")

    @property
    def usual_output(self) -> Path:
        """Where the vehicle file goes without --output."""
        return Path("results/identify") / f"{self.recording.stem}_car.toml"


def run(args: Arguments) -> int:
    # here and not above: mistakes and help are answered without them
    from driverecords.measurement import read_measurement

    from ...fmus.building.parameter_files import read_vehicle
    from ..design.design_weights import records

    vehicle = read_vehicle(args.vehicle) if args.vehicle else {}
    output = args.output or args.usual_output
    plant, _, _ = records(vehicle)
    recording = read_measurement(args.recording, plant.i, plant.r, **args.as_read)
    if args.step:
        return run_step(args, recording, vehicle, output)
    options = args.options("", (recording.name, float(recording.time[0]), float(recording.time[-1])))
    required("casadi", "identifying a model", "driveline-damping[identification]")
    from ..identification import car_file, identification_report_html
    from ..identification.prior_knowledge import identify
    from .redesign import compared_in, redesign

    runs = compared_in() if args.design else None
    same = args.distinguishing | {"vehicle": vehicle, "free": sorted(set(args.free))}
    with job(args, output.with_suffix(".json"), same, {}, [output, all_found(output)], args.read) as made:
        identified = identify(recording, vehicle, list(dict.fromkeys(args.free)), args.say)
        warnings = (f"warning: {warning}" for warning in identified.warnings)
        for line in (*car_file.identified_lines(identified), *warnings):
            args.say(line)
        car_file.identified_car(identified)  # refuses what would make no vehicle file
        made.begin()
        figure = draw(identified, recording, output.with_suffix(""), options)
        made.wrote(*write(identified, args.recording, vehicle, output), *figure)
        for provenance, path in made.reports():
            identification_report_html.report(identified, recording, provenance, path)
        if runs:
            made.wrote(*redesign(output, vehicle, runs, args.replace, args))
    return 0


def all_found(output: Path) -> Path:
    """The file beside the vehicle file."""
    return output.with_name(f"{output.stem}_identified.json")


def write(identified: "Identified", recording: Path, vehicle: Mapping[str, Any], output: Path) -> tuple[Path, Path]:
    """Writes the vehicle file, and beside it all that was found; returns both files.

    Args:
        vehicle: entries of the vehicle file that was known before.
    """
    from toolground.atomic_files import write_text

    from ..identification import car_file

    program = f"`driveline identify` (driveline-damping {version('driveline-damping')})"
    write_text(car_file.vehicle_file(identified, f"The car of {recording.name}, by {program}.", vehicle), output)
    write_text(json.dumps(car_file.document(identified), indent=2) + "\n", all_found(output))
    return output, all_found(output)


def draw(identified: "Identified", recording: "Measurement", stem: Path, options: "FigureOptions") -> list[Path]:
    """The figure, STEM.png."""
    from ..identification.fit_figures import plot_fit

    caption = f"{recording.name}, identified {identified.name}"
    return plot_fit(identified, recording, stem, options._replace(caption=caption))
