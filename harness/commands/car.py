"""Says what a vehicle file makes of a car: the entries that decide, each with its value, where it is from, and what it
costs if the car has half or twice of what the file does not tell; --all has every entry, and which blocks take it. Then
what comes of them: at which frequency the drive train swings in either plant at 15 km/h, its damping ratio without and
with control, the backlash at the wheel, and how much torque the control may take and add. docs/control.md says what
follows from what.

With control means with the gains of --parameters, or else with those that `driveline design` computes for this car.
--template writes a commented vehicle file instead: the default car, to be changed.

examples:
  driveline car my.toml
  driveline car examples/cars/van.toml --parameters van_gains.toml
  driveline car examples/cars/id3.toml --all
  driveline car                                             the default car
  driveline car my.toml --json
  driveline car --template --output my.toml
"""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from toolground.argument_types import file
from toolground.arguments import option, positional, record
from toolground.errors import UserError
from toolground.printing import JsonPrinting

from .analyse import finite
from .options import Replacing, file_of, write_toml

if TYPE_CHECKING:
    from ..studies.margins.car_properties import PlantProperties


@record
class Arguments(Replacing, JsonPrinting):
    vehicle: Path | None = positional("the car (default: that of all blocks)", file, "FILE.toml", "?")
    parameters: Path | None = file_of("what is set in the controller (default: what `driveline design` computes)")
    all: bool = option(False, "every entry, and what takes it")
    template: bool = option(False, "write a commented vehicle file")
    output: Path | None = file_of("of the template (default: it is printed)")


def run(args: Arguments) -> int:
    if args.template:
        return _template(args)
    if args.output is not None:
        raise UserError("--output is for a template: give --template")
    from ...fmus.building.car_entries import car_entries
    from ...fmus.building.parameter_files import read_parameters, read_vehicle
    from ..design.design import design
    from ..design.kalman import DesignError
    from ..design.unknowns import unknowns
    from ..studies.margins.car_properties import announce, car_properties

    values = read_vehicle(args.vehicle) if args.vehicle else {}
    entries = car_entries(values)
    origin = f"the gains of {args.parameters}" if args.parameters else "gains by `driveline design`"
    try:
        gains = read_parameters(args.parameters) if args.parameters else design(values)
    except DesignError as reason:
        gains, origin = None, f"no gains: {' '.join(str(reason).splitlines())}"
    found = car_properties(values, gains)
    unknown = unknowns(values) if args.vehicle and gains else []
    if not args.silent:
        announce(entries, found, unknown, str(args.vehicle or "the default car"), origin, args.all)
    plants = [_of_plant(plant) for plant in found.plants]
    properties = {**found._asdict(), "plants": plants}
    worth = {each.entry.name: {"settling": finite(each.settling), "overshoot": each.overshoot} for each in unknown}
    entries = [{**each._asdict(), "worth": worth.get(each.name)} for each in entries]
    args.document({"entries": entries, "gains": origin, "properties": properties})
    return 0


def _template(args: Arguments) -> int:
    from ...fmus.building.car_entries import template

    if args.vehicle is not None or args.parameters is not None or args.json or args.all:
        raise UserError("--template writes the default car: it goes with --output and --replace alone")
    if args.output is None:
        print(template(), end="")
        return 0
    write_toml(template(), args.output, args.replace)
    args.written([args.output])
    return 0


def _of_plant(plant: "PlantProperties") -> dict[str, Any]:
    return {**plant._asdict(), "damped": plant.damped and plant.damped._asdict()}
