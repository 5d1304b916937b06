"""Says what a vehicle file makes of a car: each entry with its value and unit, whether the file sets it, it follows
from others or stays as in the default car, and which blocks take it. Then what comes of them: at which frequency the
drive train swings in either plant at 15 km/h, its damping ratio without and with control, the backlash at the wheel,
and how much torque the control may take and add. docs/control.md says what follows from what.

With control means with the gains of --parameters, or else with those that `driveline design` computes for this car.
--template writes a commented vehicle file instead: the default car, to be changed.

examples:
  driveline car my.toml
  driveline car examples/cars/van.toml --parameters van_gains.toml
  driveline car                                             the default car
  driveline car my.toml --json
  driveline car --template --output my.toml
"""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..base.errors import DrivelineError
from .arguments import option, positional
from .options import Replacing, file, file_of, record
from .printing import JsonPrinting, write_toml

if TYPE_CHECKING:
    from ..studies.margins.car_properties import PlantProperties


@record
class Arguments(Replacing, JsonPrinting):
    vehicle: Path | None = positional("the car (default: that of all blocks)", file, "FILE.toml", "?")
    parameters: Path | None = file_of("what is set in the controller (default: what `driveline design` computes)")
    template: bool = option(False, "write a commented vehicle file")
    output: Path | None = file_of("of the template (default: it is printed)")


def run(args: Arguments) -> int:
    if args.template:
        return _template(args)
    if args.output is not None:
        raise DrivelineError("--output is for a template: give --template")
    from ...fmus.building.car_entries import car_entries
    from ...fmus.building.parameter_files import read_parameters, read_vehicle
    from ..design.design import design
    from ..design.kalman import DesignError
    from ..studies.margins.car_properties import announce, car_properties

    values = read_vehicle(args.vehicle) if args.vehicle else {}
    entries = car_entries(values)
    origin = f"the gains of {args.parameters}" if args.parameters else "gains by `driveline design`"
    try:
        gains = read_parameters(args.parameters) if args.parameters else design(values)
    except DesignError as reason:
        gains, origin = None, f"no gains: {' '.join(str(reason).splitlines())}"
    found = car_properties(values, gains)
    if not args.silent:
        announce(entries, found, str(args.vehicle or "the default car"), origin)
    plants = [_of_plant(plant) for plant in found.plants]
    properties = {**found._asdict(), "plants": plants}
    args.document({"entries": [each._asdict() for each in entries], "gains": origin, "properties": properties})
    return 0


def _template(args: Arguments) -> int:
    from ...fmus.building.car_entries import template

    if args.vehicle is not None or args.parameters is not None or args.json:
        raise DrivelineError("--template writes the default car: it goes with --output and --replace alone")
    if args.output is None:
        print(template(), end="")
        return 0
    write_toml(template(), args.output, args.replace)
    args.written([args.output])
    return 0


def _of_plant(plant: "PlantProperties") -> dict[str, Any]:
    return {**plant._asdict(), "damped": plant.damped and plant.damped._asdict()}
