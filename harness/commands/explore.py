"""Writes one HTML file that has the loop in it, as WebAssembly, and opens it in a browser: plant, manoeuvre or one that
is drawn by hand, gains, car, road, and the other controllers beside ours. Curves and metrics follow each slider. The
file needs no server and no network, so that it can be sent.

The page saves the car and the gains as files for the other commands, and its link carries the settings
(docs/explorer.md).

examples:
  driveline explore --vehicle examples/cars/van.toml --parameters van_gains.toml
  driveline explore my_trip.csv --manoeuvre my_manoeuvre.toml --output trip.html
  driveline explore --controller build/native/MyController.fmu --no-browser
"""

from pathlib import Path

from driverecords.arguments import Headings, recording
from toolground.arguments import option, record
from toolground.errors import UserError
from toolground.printing import Printing

from ..loop.places import PLACES
from ..manoeuvres.catalogue import MANOEUVRES
from .manoeuvres import Chosen, Listing, manoeuvre
from .options import Loop, controllers, output, plants
from .settings import all_loops


@record
class Arguments(Headings, Listing, Loop, Printing):
    recording: Path | None = recording("a recorded drive that can be chosen too", "?")
    manoeuvre: Chosen = manoeuvre("what stands first in the list: one of --list, or a file (repeatable)")
    plant: tuple[str, ...] = plants()
    controller: tuple[str, ...] = controllers("all of these")
    output: Path = output("results/explore.html", "the page")
    no_browser: bool = option(False, "the page is written and not opened")


def run(args: Arguments) -> int:
    cut = args.from_ is not None or args.to is not None
    if args.recording is None and (cut or args.dbc or args.column or args.aliases):
        raise UserError("--from, --to, --dbc, --column and --aliases are for a RECORDING; none is given")
    offered, recording = args.manoeuvre.beside(MANOEUVRES), None
    blocks = {"plant": args.plant, "controller": args.controller, "motor": [args.motor], "can": [args.can]}
    others = [Path(name) for place, names in blocks.items() for name in names if name not in PLACES[place]]
    # here and not above: mistakes and help are answered without them
    import webbrowser

    from driverecords.drive import read_drive
    from driverecords.findings import tell
    from driverecords.plausibility import of_drive
    from fmuloop.interface import Interface

    from ...fmus.building.parameter_files import read_parameters, read_vehicle
    from ..explorer.content import content, write_page
    from ..explorer.module import require_possible, sources_of
    from ..studies.drives.replay import car_of

    for path in others:
        if path.suffix == ".fmu":
            sources_of(Interface(path, args.limits))
    if not others:
        require_possible()
    if args.recording is not None:
        recording = read_drive(args.recording, **args.as_read)
    given = all_loops(args, args.plant, args.controller)
    first = next(iter(given.values()))
    T_max = first.T_max
    if args.recording is not None and recording is not None:
        tell(of_drive(recording, *car_of(first)), args.recording)
    car = read_vehicle(args.vehicle) if args.vehicle else {}
    gains = read_parameters(args.parameters) if args.parameters else {}
    write_page(content(given, car, gains, offered.with_torque(T_max).manoeuvres, recording, T_max), args.output)
    args.say(f"{args.output}: a page that needs nothing else")
    if not args.no_browser:
        webbrowser.open(args.output.resolve().as_uri())
    return 0
