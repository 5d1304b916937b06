"""`driveline replay`: a recorded drive through the simulated vehicle, without damping and with controllers."""

import argparse
from hashlib import sha256
from pathlib import Path

from ..loop.places import PLACES, PLANTS
from ..metrics.run_metrics import RideMetrics
from ..recordings.quantities import aliases, example
from ..views.html.report_page import require_report
from ..views.metrics_table import legend
from .options import (
    add_figures,
    add_format,
    add_loop,
    add_output,
    add_plant,
    add_printing,
    add_report,
    figure_options,
    seconds,
)
from .printing import Printer
from .recording_options import add_recording, of_databases
from .settings import caption, distinguishing, other_format, settings_of_each

LEGEND = legend(RideMetrics)

NAMES = aliases()
COLUMNS = ", ".join(example(quantity, NAMES) for quantity in ("time", "v", "elevation", "T_mot"))

DESCRIPTION = f"""\
Reads a recorded drive, a file with the columns

  {COLUMNS}

in any order and under any name that docs/recordings.md lists (others are ignored; without elevation the
road is level), and drives the vehicle with its torque demand, once without damping
and once with each controller. Brake and grade keep the simulated car at the recorded speed. They are
found by driving without damping and are then the same for all; nothing in them is as fast as 1 Hz
(docs/replay.md). The table shows

{LEGEND}

in brackets over that without damping, and goes to RECORDING_metrics.csv and RECORDING_table.md in the output
folder, the signals to RECORDING_off.csv and RECORDING_CONTROLLER.csv (or --format), the figure to RECORDING.png and
RECORDING.pdf (or --figures), in the units of the recording.
"""

EXAMPLES = """\
examples:
  driveline replay harness/manoeuvres/data/town_drive.csv
  driveline replay my_trip.csv --controller DampingController --controller SpeedWashout
  driveline replay bench.csv --column v='n_roller [km/h]' --column T_mot='-M_em [Nm]'
  driveline replay my_trip.blf --dbc drive_train.dbc
  driveline replay my_trip.csv --held 0.5 --output results/rough_foot
  driveline replay my_trip.csv --window 310,325 --figures svg
  driveline replay my_trip.csv --set plant.m=1900
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_recording(parser, "the recorded drive")
    add_plant(parser, default=PLANTS[1])
    parser.add_argument(
        "--held",
        type=seconds,
        metavar="SECONDS",
        help="sample and hold the demand for so long, a rougher foot (default: straight lines)",
    )
    add_loop(parser, several={"controller": PLACES["controller"][0]})
    add_output(parser, "results/replay", "the metrics, the signals and the figure", of_a_run=True)
    add_format(parser)
    add_figures(parser)
    add_report(parser)
    add_printing(parser, table=True)


def run(args: argparse.Namespace) -> int:
    # here and not above: mistakes and help are answered without them
    from ..cosimulation.wiring import fit
    from ..manoeuvres.road_load import RoadLoad, Track, torque_limit
    from ..manoeuvres.speed_following import require_held
    from ..recordings.drive import read_drive
    from ..simulation.provenance import content, recorded
    from ..simulation.simulate import looped
    from ..studies.drives.replay import by_name, records, replay, write
    from ..views.signals_file import require_format
    from ..views.terminal import print_table, rides_reasons, rides_table

    out = Printer(args)
    require_report(args.report)
    require_held(args.held)
    require_format(args.format)
    recording = read_drive(args.recording, dict(args.columns), args.aliases, args.databases)
    if recording.elevation is None:
        out.say(f"{args.recording} has no elevation: the road is level")
    controllers = by_name(args.controller or PLACES["controller"][:1])
    plant = Path(args.plant).stem
    given = settings_of_each(args, args.plant, controllers)
    systems = {name: looped(args.plant, settings) for name, settings in given.items()}
    first = next(iter(given))
    interfaces, parameters = fit(systems[first]).interfaces, given[first]["parameters"]
    load = RoadLoad.of_plant(interfaces["plant"], parameters)
    track = Track.of(recording, torque_limit(interfaces["motor"], parameters))
    drawing = figure_options(args, caption(args), (recording.name, 0.0, float(track.t[-1])))
    record, metrics = (args.output / f"{recording.name}{end}" for end in (".json", "_metrics.csv"))
    same = {"recording": sha256(args.recording.read_bytes()).hexdigest(), "held": args.held, "controllers": list(given)}
    same |= {"columns": dict(args.columns)} | of_databases(args) | other_format(args)
    same |= {f"with {name}": distinguishing(given[name], system, None) for name, system in systems.items()}
    read = [args.recording, *args.databases, *args.aliases, args.vehicle, args.parameters]
    report = [args.report] if args.report else []
    with recorded(record, same, systems, read, [metrics, *report], args.replace) as made:
        out.say(
            f"{recording.name}: {track.t[-1]:.0f} s on {plant}, {given[first]['build']} FMUs, without damping and "
            f"with {', '.join(given)}"
        )
        rides = replay(track, load, args.plant, given, args.held)
        shown = {ride.controller: ride.metrics for ride in rides}
        if not out.silent:
            print_table(rides_table(shown, f"{plant} on {recording.name}"))
        reasons = rides_reasons(shown)
        for reason in reasons:
            out.say(reason)
        out.say(f"{LEGEND}\n")
        made.begin()
        made.files += write(rides, track, plant, args.output, drawing, args.format, recording.file_units)
        if args.report:
            from ..studies.drives import replay_report as page

            drawn = {ride.controller: (ride.metrics, ride.signals) for ride in rides}
            title = f"{plant} on the recorded drive {track.name}"
            page.report(drawn, (track.t, track.v), title, reasons, content(same, made.fits, [], read), args.report)
            made.files += report
    for file in (*made.files, record):
        out.say(f"written: {file}")
    out.document({"runs": records(rides, track, plant), "files": made.files})
    return 0
