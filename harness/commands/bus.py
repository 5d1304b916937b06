"""Writes the database of the bus, driveline.dbc, from what the blocks declare of their frames: the wheel speed as the
ABS unit sends it (identifier, cycle, resolution, range), and what motor control says of the motor and is asked to make.
With it other tools, and `driveline replay --dbc`, read logs of that bus; `driveline simulate --frames blf` writes some.

The cycle and the resolution are those of the car of a vehicle file (T_cyc, q_v). Needs the extra `recordings`.

examples:
  driveline bus
  driveline bus --vehicle examples/cars/van.toml --output results/van_bus
"""

import argparse

from ..loop.places import PLACES
from .options import add_output, add_printing
from .printing import Printer


def add_arguments(parser: argparse.ArgumentParser) -> None:
    from ...fmus.building.options import file

    parser.add_argument("--vehicle", type=file, metavar="FILE.toml", help="what belongs to the car")
    add_output(parser, "results/bus", "the database")
    add_printing(parser)


def run(args: argparse.Namespace) -> int:
    from ...fmus.building.parameter_files import read_vehicle
    from ..exchange.bus.database import telegrams, write_dbc

    car, path = read_vehicle(args.vehicle) if args.vehicle else {}, args.output / "driveline.dbc"
    write_dbc(telegrams(dict.fromkeys(PLACES, car)), path)
    Printer(args).files([path])
    return 0
