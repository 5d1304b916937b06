"""Builds the FMU of a controller whose start, step and outputs are computed by its C on an emulated Cortex-M4F (QEMU,
machine mps2-an386), which starts with the run and ends with it. It has the variables of the ordinary one and stands in
its place, in `driveline simulate --controller` and in any other host: the rest of the loop is unchanged.

A target that is lost, hangs or crashes is an error that names it, within a second. It needs
`apt-get install gcc-arm-none-eabi libnewlib-arm-none-eabi qemu-system-arm`; to run, the last alone.

examples:
  driveline target build
  driveline simulate --controller build/on_target/DampingController.fmu --manoeuvre launch --plot
  driveline compare --controller build/on_target/DampingController.fmu --plant ValidationVehicle
  driveline target build --vehicle car.toml --parameters gains.toml --output car/on_target
"""

import argparse

from ...fmus.building.options import output_folder
from .options import add_controller, add_printing
from .printing import Printer


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_controller(parser)
    parser.add_argument(
        "--output", type=output_folder, default="build/on_target", metavar="FOLDER", help="(default: %(default)s)"
    )
    add_printing(parser)


def run(args: argparse.Namespace) -> int:
    # here and not above: mistakes and help are answered without them
    from ...fmus.target.image import build_on_target
    from ..exchange.target.controllers import for_car

    path = build_on_target(for_car(args.controller, args.vehicle, args.parameters), args.output)
    Printer(args).say(f"{path}  {path.stat().st_size / 1024:.0f} kB")
    return 0
