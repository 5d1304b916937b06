"""`driveline replay`: a recorded drive through the simulated vehicle, without and with damping."""

import argparse
from hashlib import sha256
from pathlib import Path

from ..control_loop import PLANTS
from ..manoeuvres.recording import COLUMNS
from ..metrics.record import RideMetrics
from ..reports.table import legend
from .built import built
from .options import add_loop, add_output, add_plant, add_printing, seconds
from .printing import Printer
from .settings import blocks, caption, distinguishing, settings

LEGEND = legend(RideMetrics)

DESCRIPTION = f"""\
Reads a recorded drive, a CSV file with the columns

  {", ".join(column.example for column in COLUMNS.values())}

in any order (others are ignored), and drives the vehicle with its torque demand and its road, once
without and once with damping. Friction brakes are seldom recorded: they get what the balance of
forces along the road leaves over, and they hold the car where the recorded one stands. The table
shows

{LEGEND}

and goes to RECORDING_metrics.csv in the output folder, the signals to RECORDING_on.csv and
RECORDING_off.csv, the figure to RECORDING.png and RECORDING.pdf.
"""

EXAMPLES = """\
examples:
  driveline replay harness/manoeuvres/data/town_drive.csv
  driveline replay my_trip.csv --held 0.5 --output results/rough_foot
  driveline replay my_trip.csv --set plant.m=1900
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    file = parser.add_argument("recording", type=Path, metavar="RECORDING.csv", help="the recorded drive")
    file.complete = "file"  # type: ignore[attr-defined]
    add_plant(parser, default=PLANTS[1])
    parser.add_argument(
        "--held",
        type=seconds,
        metavar="SECONDS",
        help="sample and hold the demand for so long, a rougher foot (default: straight lines)",
    )
    add_loop(parser)
    add_output(parser, "results/replay", "the metrics, the signals and the figure", of_a_run=True)
    add_printing(parser, table=True)


def run(args: argparse.Namespace) -> int:
    # here and not above: mistakes and help are answered without them
    from ..cosimulation.wiring import fit
    from ..manoeuvres.recording import read_recording
    from ..manoeuvres.road import RoadLoad, road, torque_limit
    from ..provenance import recorded
    from ..replay import records, replay, write
    from ..reports.terminal import print_table, rides_reasons, rides_table
    from ..simulate import looped

    out = Printer(args)
    recording = read_recording(args.recording)
    build = built(args.plant, args.fmus, args.build, **blocks(args))
    given, plant = settings(args, args.plant, build), Path(args.plant).stem
    system = looped(args.plant, given)
    interfaces, parameters = fit(system).interfaces, given["parameters"]
    load = RoadLoad.of_plant(interfaces["plant"], parameters)
    manoeuvre = road(recording, load, args.held, torque_limit(interfaces["motor"], parameters))
    record, metrics = (args.output / f"{recording.name}{end}" for end in (".json", "_metrics.csv"))
    same = {"recording": sha256(args.recording.read_bytes()).hexdigest(), "held": args.held}
    same |= distinguishing(given, system, manoeuvre)
    read = [args.recording, args.vehicle, args.parameters]
    with recorded(record, same, {plant: system}, read, [metrics], args.replace) as made:
        out.say(f"{recording.name}: {manoeuvre.duration:.0f} s on {plant}, {build} FMUs, without and with damping")
        rides = replay(manoeuvre, recording, args.plant, **given)
        if not out.silent:
            print_table(rides_table(rides[0].metrics, rides[1].metrics, f"{plant} on {recording.name}"))
        for reason in rides_reasons(rides[0].metrics, rides[1].metrics):
            out.say(reason)
        out.say(f"{LEGEND}\n")
        made.begin()
        made.files += write(rides, recording, plant, args.output, caption(args))
    for file in (*made.files, record):
        out.say(f"written: {file}")
    out.document({"runs": records(rides, recording, plant), "files": made.files})
    return 0
