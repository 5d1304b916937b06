"""Identifies the drive train from a recording of a test drive: the inertia of the wheels J_2, the stiffness C and half
the gap phi_B, each with its 95 % interval, the lag of motor control where the torque demand was recorded, and
structural damping where the data ask for it. Written are the vehicle file, which other commands take as --vehicle,
beside it all that was found (NAME_identified.json), what made it (NAME.json) and four figures.

The recording is a file with the columns

  {columns}

under any name that docs/recordings.md lists (the wheel speed tells wrong units and signs; the fit does not
use it). It finds more with {more}. Two results have different names, as they mean different things:

  with load torque                  measurement wheels were recorded: J_2 is that of the wheels
  effective, without load torque    J_2 carries the vehicle

g_T and g_L are the gains of the recorded motor and load torque, 1 if they are right; d is structural damping. late_1,
late_T and late_L are the times by which motor speed, motor torque and load torque are recorded late, of which there are
those that the data ask for, up to 6 ms and less than a sample too.

Where the model explains the recording, prediction error is used (innovations of an extended Kalman filter); where it
does not, output error over pieces of 0.5 s. The fit is judged on the last quarter, with parameters found without it.
What is likely to be wrong with the recording, or is not determined by it, is said. A stiffness that is known to no
better than +- 50 % makes no vehicle file, and a gap that is known no better stays as it was. The figures are measured
and simulated signals, the innovations, the cost over each pair of parameters, the frequency response.

examples:
  driveline record && driveline identify results/record/TwoMassDriveline_prbs_off.csv --output car.toml
  driveline identify drive.mf4 --vehicle examples/cars/van.toml --output my_van.toml
  driveline identify drive.csv --free J_1 --column T_mot='M_em [Nm]'
  driveline identify drive.blf --dbc drive_train.dbc
  driveline identify drive.csv --design
"""

import json
import os
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..base.errors import DrivelineError
from ..base.optional_packages import required
from .arguments import option
from .jobs import job
from .options import Figures, Replacing, Report, file_of, record
from .printing import Printing
from .recorded import Recorded, examples, recording

if TYPE_CHECKING:
    from ..identification.identify import Identified
    from ..recordings.measurement import Measurement
    from ..views.figure_options import FigureOptions

FREE = ("J_1", "d", "g_T")

IN_HELP = {
    "columns": ", ".join(examples("time", "T_mot", "omega_1", "omega_wheel")),
    "more": " and ".join(examples("T_wheel", "T_ref")),
}


@record
class Arguments(Recorded, Figures, Replacing, Report, Printing):
    recording: Path = recording("the recorded test drive")
    vehicle: Path | None = file_of("what is known of the car (default: that of all blocks)")
    free: tuple[str, ...] = option((), "identify this too (repeatable); d is freed where the data ask", choices=FREE)
    output: Path | None = option(
        None, "the vehicle file (default: results/identify/RECORDING_car.toml)", Path, metavar="FILE.toml"
    )
    design: bool = option(False, "compute gains for this car, build the controller, compare on both plants")


def run(args: Arguments) -> int:
    # here and not above: mistakes and help are answered without them
    from ...fmus.building.parameter_files import read_vehicle

    vehicle = read_vehicle(args.vehicle) if args.vehicle else {}
    output = args.output or Path("results/identify") / f"{args.recording.stem}_car.toml"
    require_possible(args.free, output)
    recording = read(args, vehicle)
    options = args.options("", (recording.name, float(recording.time[0]), float(recording.time[-1])))
    required("casadi", "identifying a model", "identification")
    runs = None
    if args.design:
        from .redesign import compared_in, redesign

        runs = compared_in()
    from ..identification.prior_knowledge import identify

    same, first = (
        args.distinguishing | {"vehicle": vehicle, "free": sorted(set(args.free))},
        [output, all_found(output)],
    )
    with job(args, output.with_suffix(".json"), same, {}, first, args.read) as made:
        identified = identify(recording, vehicle, list(dict.fromkeys(args.free)), args.say)
        say(identified, recording, args)
        require_known(identified)
        made.begin()
        figures = draw(identified, recording, output.with_suffix(""), options)
        made.wrote(*write(identified, args.recording, vehicle, output), *figures)
        for provenance, path in made.reports():
            report(identified, recording, provenance, path)
        if runs:
            made.wrote(*redesign(output, vehicle, runs, args.replace, args))
    return 0


def read(args: Arguments, vehicle: Mapping[str, Any]) -> "Measurement":
    """The recording, of the car of a vehicle file."""
    from ..design.design_weights import records
    from ..recordings.measurement import read_measurement

    plant, _, _ = records(vehicle)
    return read_measurement(args.recording, plant.i, plant.r, dict(args.column), args.aliases, args.dbc)


def require_known(identified: "Identified") -> None:
    """Refuses what would make no vehicle file."""
    from ..identification.car_file import identified_car

    identified_car(identified)


def all_found(output: Path) -> Path:
    """The file beside the vehicle file."""
    return output.with_name(f"{output.stem}_identified.json")


def require_possible(free: Sequence[str], output: Path) -> None:
    """
    Raises:
        DrivelineError: the vehicle file cannot be written, or what is to be identified cannot be told apart.
    """
    if output.suffix != ".toml":
        raise DrivelineError(f"--output {output}: a vehicle file is a .toml")
    there = next(folder for folder in output.absolute().parents if folder.exists())
    if not (there.is_dir() and os.access(there, os.W_OK)):
        raise DrivelineError(f"--output {output}: {there} is no folder that can be written to")
    if {"J_1", "g_T"} <= set(free):
        raise DrivelineError("--free J_1 --free g_T: nothing sets their scale together; free one of them")


def say(identified: "Identified", recording: "Measurement", out: Printing) -> None:
    """What was found, and what is likely to be wrong with the recording."""
    from ..identification import car_file

    delays, warnings = (f"delay: {delay}" for delay in recording.delays), (f"warning: {w}" for w in identified.warnings)
    for line in (*delays, *car_file.identified_lines(identified), *warnings):
        out.say(line)


def write(identified: "Identified", recording: Path, vehicle: Mapping[str, Any], output: Path) -> tuple[Path, Path]:
    """Writes the vehicle file, and beside it all that was found; returns both files.

    Args:
        vehicle: entries of the vehicle file that was known before.
    """
    from ..base.atomic_files import write_text
    from ..identification import car_file

    program = f"`driveline identify` (driveline-damping {version('driveline-damping')})"
    write_text(car_file.vehicle_file(identified, f"The car of {recording.name}, by {program}.", vehicle), output)
    write_text(json.dumps(car_file.document(identified), indent=2) + "\n", all_found(output))
    return output, all_found(output)


def report(identified: "Identified", recording: "Measurement", provenance: Mapping[str, Any], path: Path) -> None:
    from ..identification import identification_report_html

    identification_report_html.report(identified, recording, provenance, path)


def draw(identified: "Identified", recording: "Measurement", stem: Path, options: "FigureOptions") -> list[Path]:
    """The figures, STEM_simulation.png and so on."""
    from ..identification.fit_figures import plot_innovations, plot_simulation
    from ..identification.uncertainty_figures import plot_cost, plot_response

    def named(what: str) -> Path:
        return stem.with_name(f"{stem.name}_{what}")

    one = options._replace(caption=f"{recording.name}, identified {identified.name}, by {identified.method}")
    return [
        *plot_simulation(identified, recording, named("simulation"), one),
        *plot_innovations(identified, named("innovations"), one),
        *plot_cost(identified, named("cost"), one),
        *plot_response(identified, named("response"), one),
    ]
