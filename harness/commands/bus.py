"""Writes the database of the bus, driveline.dbc, from what the blocks declare of their frames: the wheel speed as the
ABS unit sends it (identifier, cycle, resolution, range), and what motor control says of the motor and is asked to make.

With it other tools, and `driveline replay --dbc`, read logs of that bus; `driveline simulate --frames blf` writes some.
With --fmu it also builds WheelSpeedCan as an FMU of FMI 3.0 that sends its frames to other FMUs or to a simulation of
the bus, as binary variables with clocks (FMI-LS-BUS); the database is in it. The cycle and the resolution are those of
the car of a vehicle file (T_cyc, q_v). Needs the extra `recordings`.

examples:
  driveline bus
  driveline bus --fmu
  driveline bus --vehicle examples/cars/van.toml --output results/van_bus
"""

from pathlib import Path

from fmublocks.builds import PLATFORMS
from toolground.arguments import option, record
from toolground.printing import Printing

from ..loop.places import PLACES
from .options import file_of, output


@record
class Arguments(Printing):
    vehicle: Path | None = file_of("what belongs to the car")
    fmu: str | None = option(
        None,
        "build the FMU too, for this machine, or for Linux, Windows and macOS (all)",
        choices=PLATFORMS,
        nargs="?",
        const=PLATFORMS[0],
        metavar="PLATFORM",
    )
    output: Path = output("results/bus", "the database")


def run(args: Arguments) -> int:
    from fmublocks.builds import sender_builder

    from ...fmus.building.parameter_files import read_vehicle
    from ...fmus.catalogue import FMUS
    from ..exchange.bus.database import dbc, telegrams, write_dbc

    car, path = read_vehicle(args.vehicle) if args.vehicle else {}, args.output / "driveline.dbc"
    sent, made = telegrams(dict.fromkeys(PLACES, car)), [path]
    if args.fmu:
        made.append(sender_builder(dbc(sent), args.fmu)(FMUS["WheelSpeedCan"].started_with(car), args.output))
    write_dbc(sent, path)
    args.written(made)
    return 0
