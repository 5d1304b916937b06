"""Serves a page on this machine alone, for a browser: plant, manoeuvre, backlash, stiffness, mass, delay, gains, sport
to comfort, control on and off, and the other controllers beside ours. Curves and metrics follow; the run without
control stands behind in grey, and any run can be held beside those that follow. A recorded drive and manoeuvres
from files can be driven too.

A click saves the car and the gains as files for --vehicle and --parameters of the other commands, another one a report
(docs/explorer.md). Ctrl-C ends it.

examples:
  driveline explore
  driveline explore --vehicle examples/cars/van.toml --parameters van_gains.toml
  driveline explore my_trip.csv
  driveline explore --manoeuvre my_manoeuvre.toml
  driveline explore --plant my_vehicle.fmu --controller my_controller.fmu
  driveline explore --port 8000
"""

import argparse
from argparse import ArgumentTypeError
from pathlib import Path

from ..base.status_line import no_longer_waiting
from ..manoeuvres.catalogue import MANOEUVRES
from ..views.html.report_page import require_drawing
from .manoeuvres import add_manoeuvre, chosen
from .options import add_loop, add_output, add_plant, add_printing, assignment, count
from .printing import Printer
from .recording_options import add_recording
from .settings import settings_of_pairs

PORT = 5006


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_recording(parser, "a recorded drive that can be chosen too", nargs="?")
    add_manoeuvre(
        parser,
        "what stands first in the list: a name of the catalogue, or a file (repeatable)",
        action="append",
        default=[],
    )
    add_plant(parser, several=True)
    add_loop(parser, several={"controller": "all of these"})
    parser.add_argument(
        "--port",
        type=_port,
        default=PORT,
        metavar="NUMBER",
        help="of the page (default: %(default)s; 0: any that is free)",
    )
    add_output(parser, "results/explore", "what a click saves")
    add_printing(parser)


def _port(text: str) -> int:
    return count(text, 0, 65535)


def run(args: argparse.Namespace) -> int:
    # here and not above: mistakes and help are answered without them
    asked, offered = chosen(args.manoeuvre), chosen([*args.manoeuvre, *MANOEUVRES]).manoeuvres
    given = settings_of_pairs(args)
    from ...fmus.building.parameter_files import read_parameters, read_vehicle
    from ..explorer.request_runs import Answer, RequestRunner
    from ..explorer.saving import save_files, save_report
    from ..explorer.server import serve
    from ..recordings.drive import read_drive

    recording = None
    if args.recording is not None:
        recording = read_drive(args.recording, dict(args.columns), args.aliases, args.databases)
    car = read_vehicle(args.vehicle) if args.vehicle else {}
    runner, out = RequestRunner(given, car, offered, recording), Printer(args)
    fits = {plant: runner.fit(plant, runner.controllers[0]) for plant in runner.plants}
    asked.require_drivable(fits, {plant: runner.settings(plant) for plant in runner.plants})
    read = [args.vehicle, args.parameters, args.recording, *asked.files.values()]
    gains = read_parameters(args.parameters) if args.parameters else {}

    def files(answer: Answer) -> list[Path]:
        return save_files(runner, answer.request, gains, args.output)

    def report(answer: Answer) -> list[Path]:
        require_drawing("a report")
        return [save_report(runner, answer, read, args.output)]

    def announce(address: str) -> None:
        no_longer_waiting()
        out.say(f"{address} (Ctrl-C ends it)")

    serve(runner, {"save car and gains": files, "save report": report}, _typed, args.port, announce)
    return 0


def _typed(text: str) -> tuple[str, float]:
    try:
        return assignment(text)
    except ArgumentTypeError as refusal:
        raise ValueError(str(refusal)) from refusal
