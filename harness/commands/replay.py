"""Drives the vehicle with the torque demand of a recorded drive, once without damping and once with each controller.
Brake and grade keep the simulated car at the recorded speed: they are found by driving without damping and are then
the same for all; nothing in them is as fast as 1 Hz (docs/recordings.md).

The recording is a file with the columns

  {columns}

under any name that docs/recordings.md lists (without elevation the road is level). The table, which goes to
RECORDING_metrics.csv and RECORDING_table.md, shows, in brackets over that without damping,

{metrics}

What makes the recording implausible is said with column and time before it is driven and after, and stands with the
results: signs, units, rates, codes for missing values, spikes, jumps (docs/recordings.md#plausibility).

examples:
  driveline replay my_trip.csv --look
  driveline replay harness/manoeuvres/data/town_drive.csv
  driveline replay my_trip.csv --controller DampingController --controller SpeedWashout
  driveline replay bench.csv --column v='n_roller [km/h]' --column T_mot='-M_em [Nm]'
  driveline replay my_trip.blf --dbc drive_train.dbc --held 0.5 --output results/rough_foot
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from driverecords.arguments import examples, recording
from toolground.argument_types import seconds
from toolground.arguments import option, record
from toolground.errors import UserError
from toolground.printing import JsonPrinting

from ..loop.places import PLACES, PLANTS
from ..metrics.run_metrics import RideMetrics
from ..views.metrics_table import legend
from .jobs import RunJob, distinguishing, job
from .options import Figures, Loop, Replacing, Report, SignalsFormat, controllers, output, plant
from .recorded import Recorded
from .settings import all_loops, caption

if TYPE_CHECKING:
    from driverecords.drive import Drive
    from driverecords.findings import Finding

    from ..loop.resolved import ResolvedLoop
    from ..manoeuvres.road_load import RoadLoad, Track
    from ..studies.drives.replay import Ride

IN_HELP = {"columns": ", ".join(examples("time", "v", "elevation", "T_mot")), "metrics": legend(RideMetrics)}


@record
class Arguments(Recorded, Loop, Replacing, SignalsFormat, Figures, Report, JsonPrinting):
    recording: Path = recording("the recorded drive")
    plant: str = plant(PLANTS[1])
    held: float | None = option(None, "hold the demand for so long, as a rougher foot does", seconds, metavar="SECONDS")
    look: bool = option(False, "run nothing: print and draw what was found in the recording")
    strict: bool = option(False, "refuse a recording in which something is odd")
    controller: tuple[str, ...] = controllers(PLACES["controller"][0])
    output: Path = output("results/replay", "metrics, signals and figure")


def run(args: Arguments) -> int:
    # here and not above: mistakes and help are answered without them
    from driverecords.drive import read_drive
    from driverecords.findings import tell
    from driverecords.plausibility import of_drive

    from ..manoeuvres.road_load import Track
    from ..manoeuvres.speed_following import require_held
    from ..studies.drives.replay import car_of

    if args.look and args.report:
        raise UserError("--look runs nothing, so that there is nothing to --report")
    require_held(args.held)
    recording = read_drive(args.recording, **args.as_read)
    same = args.distinguishing | {"held": args.held} | args.other_format
    found = all_loops(args, [args.plant], args.controller or PLACES["controller"][:1])
    given = {controller: made for (_, controller), made in found.items()}
    load, T_max = car_of(next(iter(given.values())))
    odd = of_drive(recording, load, T_max)
    if args.look:
        return look(args, recording, odd)
    tell(odd, args.recording, args.strict)
    drive(args, recording, odd, Track.of(recording, T_max), load, given, same)
    return 0


def drive(
    args: Arguments,
    recording: "Drive",
    odd: "Sequence[Finding]",
    track: "Track",
    load: "RoadLoad",
    given: "Mapping[str, ResolvedLoop]",
    same: Mapping[str, Any],
) -> None:
    """Makes the rides with each controller, and writes and tells what they are worth.

    Args:
        odd: what makes the recording implausible before it is driven.
        load: of the plant.
        given: loops by the names of the controllers.
        same: what distinguishes the run beside them.
    """
    from driverecords.findings import tell

    from ..studies.drives.replay import replay, write
    from ..studies.drives.verdict import followed_speed
    from ..views.terminal import rides_reasons

    options = args.options(caption(args), (recording.name, 0.0, float(track.t[-1])))
    same = {**same, "controllers": list(given)} | {f"with {n}": distinguishing(each) for n, each in given.items()}
    record, metrics = (args.output / f"{recording.name}{end}" for end in (".json", "_metrics.csv"))
    settings = next(iter(given.values())).settings
    plant, build, fits = settings.plant_name, settings.build, {name: each.fit for name, each in given.items()}
    with job(args, record, same, fits, [metrics], args.read) as made:
        level = "" if recording.elevation is not None else "; it has no elevation: the road is level"
        args.say(f"{recording.name}: {track.t[-1]:.0f} s on {plant}, {build} FMUs, {', '.join(given)}{level}")
        rides = replay(track, load, given, args.held)
        unkept = followed_speed(recording, rides) if args.held is None else []  # it is not meant to keep the speed
        tell(unkept, args.recording, args.strict)
        odd = [*odd, *unkept]
        made.begin()
        made.found({ride.controller: ride.signals for ride in rides})
        notes = [f"not plausible: {finding}" for finding in odd]
        below = [*rides_reasons({ride.controller: ride.metrics for ride in rides}), *notes]
        made.wrote(*write(rides, track, plant, args.output, options, args.format, recording.file_units, below))
        _tell(made, rides, track, plant, odd, notes)


def _tell(
    made: RunJob, rides: "Sequence[Ride]", track: "Track", plant: str, odd: "Sequence[Finding]", notes: list[str]
) -> None:
    """Writes the report, if one is asked for, and tells what the rides are worth."""
    from ..studies.drives import replay_report
    from ..studies.drives.replay import records
    from ..views.terminal import print_rides, rides_reasons

    metrics = {ride.controller: ride.metrics for ride in rides}
    reasons = rides_reasons(metrics)
    for provenance, path in made.reports():
        drawn = {ride.controller: (ride.metrics, ride.signals) for ride in rides}
        title, texts = f"{plant} on the recorded drive {track.name}", [str(finding) for finding in odd]
        replay_report.report(drawn, (track.t, track.v), title, reasons, texts, provenance, path)
    found = {"runs": records(rides, track, plant), "findings": [finding.document() for finding in odd]}
    made.tell(print_rides, metrics, f"{plant} on {track.name}", [*reasons, *notes], **found)


def look(args: Arguments, recording: "Drive", odd: "Sequence[Finding]") -> int:
    """Shows a recording, without any run."""
    from driverecords.column_table import document, show

    from ..views.recording_view import plot_recording

    options = args.options("", (recording.name, float(recording.time[0]), float(recording.time[-1])))
    show(args, args.recording, recording, odd, args.strict)
    kinds = tuple(args.figures or ("png",))
    figures = plot_recording(recording, odd, args.output / f"{recording.name}_look", options._replace(kinds=kinds))
    args.written(figures)
    args.document({**document(recording, odd), "files": figures})
    return 0
