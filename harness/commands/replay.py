"""`driveline replay`: a recorded drive through the simulated vehicle, without and with damping."""

import argparse
from pathlib import Path

from ..cosimulation.system import BUILD_HELP, BUILDS, PLANTS, chosen_build, loop
from ..errors import DrivelineError
from ..manoeuvres.recording import COLUMNS, read_recording
from ..manoeuvres.road import RoadLoad, road
from ..replay import replay, write
from ..reports.terminal import rides_table, wide_console

NAME = "replay"
HELP = "drive a recorded torque demand and road without and with damping"

DESCRIPTION = f"""\
Reads a recorded drive, a CSV file with the columns

  {", ".join(column.example for column in COLUMNS.values())}

in any order (others are ignored), and drives the vehicle with its torque demand and its road, once
without and once with damping. Friction brakes are seldom recorded: they get what the balance of
forces along the road leaves over, and they hold the car where the recorded one stands. The speed is
not forced on the simulated car; how far it strays from the recorded one is reported.
"""

EXAMPLES = """\
examples:
  driveline replay harness/manoeuvres/data/town_drive.csv
  driveline replay my_trip.csv --held 0.5 --output results/rough_foot
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("recording", type=Path, metavar="RECORDING.csv", help="the recorded drive")
    parser.add_argument(
        "--plant",
        default=PLANTS[1],
        metavar="NAME|FILE",
        help=f"{' or '.join(PLANTS)}, or an FMU with the same interface (default: %(default)s)",
    )
    parser.add_argument(
        "--held",
        type=float,
        metavar="SECONDS",
        help="sample and hold the demand for so long, a rougher foot (default: straight lines)",
    )
    parser.add_argument("--build", choices=BUILDS, help=BUILD_HELP)
    parser.add_argument("--seed", type=int, default=1, help="of the sensor noise (default: %(default)s)")
    parser.add_argument(
        "--output",
        type=Path,
        default=Path("results/replay"),
        metavar="FOLDER",
        help="for the table, the signals and the figure (default: %(default)s)",
    )


def run(args: argparse.Namespace) -> int:
    if args.held is not None and not 0.0 < args.held < float("inf"):
        raise DrivelineError(f"--held {args.held:g}: the demand is held for a time above 0 s")
    if not args.recording.is_file():
        raise DrivelineError(f"there is no recording {args.recording}")
    recording = read_recording(args.recording)
    build = args.build or chosen_build(args.plant)
    path = loop(args.plant, build=build).instances["plant"]
    manoeuvre = road(recording, RoadLoad.of_fmu(path), args.held)
    console = wide_console()
    console.print(
        f"{recording.name}: {manoeuvre.duration:.0f} s on {path.stem}, {build} FMUs, without and with damping"
    )
    rides = replay(manoeuvre, recording, args.plant, args.seed, build=build)
    console.print(rides_table(rides[0].metrics, rides[1].metrics, f"{path.stem} on {recording.name}"))
    for file in write(rides, recording, path.stem, args.output):
        console.print(f"written: {file}", soft_wrap=True)
    return 0
