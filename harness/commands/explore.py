"""Serves a page on this machine alone, for a browser: plant, manoeuvre, backlash, stiffness, mass, delay, gains, sport
to comfort, control on and off, and the other controllers beside ours. Curves and metrics follow; the run without
control stands behind in grey, and any run can be held beside those that follow. Ctrl-C ends it.

A click saves the car and the gains as files for the other commands, another one a report (docs/explorer.md).

examples:
  driveline explore --vehicle examples/cars/van.toml --parameters van_gains.toml
  driveline explore my_trip.csv --manoeuvre my_manoeuvre.toml
  driveline explore --plant my_vehicle.fmu --controller my_controller.fmu
"""

from argparse import ArgumentTypeError
from pathlib import Path

from ..base.status_line import no_longer_waiting
from ..manoeuvres.catalogue import MANOEUVRES
from .arguments import option
from .manoeuvres import Chosen, Listing, manoeuvre
from .options import Loop, assignment, controllers, counted, output, plants, record
from .printing import Printing
from .recorded import Headings, recording
from .settings import all_settings


@record
class Arguments(Headings, Listing, Loop, Printing):
    recording: Path | None = recording("a recorded drive that can be chosen too", "?")
    manoeuvre: Chosen = manoeuvre("what stands first in the list: one of --list, or a file (repeatable)")
    plant: tuple[str, ...] = plants()
    controller: tuple[str, ...] = controllers("all of these")
    port: int = option(
        5006, "of the page (default: %(default)s; 0: any that is free)", counted(0, 65535), metavar="NUMBER"
    )
    output: Path = output("results/explore", "what a click saves")


def run(args: Arguments) -> int:
    offered = args.manoeuvre.beside(MANOEUVRES)
    given = all_settings(args, args.plant, args.controller)
    # here and not above: mistakes and help are answered without them
    from ...fmus.building.parameter_files import read_parameters, read_vehicle
    from ..explorer.request_runs import Answer, RequestRunner
    from ..explorer.saving import save_files, save_report
    from ..explorer.server import serve
    from ..manoeuvres.drivable import require_possible
    from ..recordings.drive import read_drive
    from ..views.html.report_page import require_drawing

    recording = None
    if args.recording is not None:
        recording = read_drive(args.recording, **args.as_read)
    car = read_vehicle(args.vehicle) if args.vehicle else {}
    runner = RequestRunner(given, car, offered, recording)
    fits = {plant: runner.fit(plant, runner.controllers[0]) for plant in runner.plants}
    require_possible(*args.manoeuvre, fits, {plant: runner.settings(plant) for plant in runner.plants})
    read = [args.vehicle, args.parameters, args.recording, *args.manoeuvre.files.values()]
    gains = read_parameters(args.parameters) if args.parameters else {}

    def files(answer: Answer) -> list[Path]:
        return save_files(runner, answer.request, gains, args.output)

    def report(answer: Answer) -> list[Path]:
        require_drawing("a report")
        return [save_report(runner, answer, read, args.output)]

    def announce(address: str) -> None:
        no_longer_waiting()
        args.say(f"{address} (Ctrl-C ends it)")

    serve(runner, {"save car and gains": files, "save report": report}, _typed, args.port, announce)
    return 0


def _typed(text: str) -> tuple[str, float]:
    try:
        return assignment(text)
    except ArgumentTypeError as refusal:
        raise ValueError(str(refusal)) from refusal
