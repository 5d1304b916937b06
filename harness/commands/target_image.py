"""Compiles the image with a controller behind a link for the emulated Cortex-M4F, controller.elf, and describes it for
calibration tools in controller.a2l (ASAM MCD-2 MC): parameters, inputs and outputs with units, limits, meanings, and
their addresses in that image. The parameters lie in one record in RAM, `calibration`, and what is written there acts
from the next sample on.

It needs `apt-get install gcc-arm-none-eabi libnewlib-arm-none-eabi qemu-system-arm`.

examples:
  driveline target image
  driveline target image --vehicle car.toml --parameters gains.toml --output car/image
"""

import argparse

from .options import add_controller, add_output, add_printing
from .printing import Printer


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_controller(parser)
    add_output(parser, "build/image", "the image and its description")
    add_printing(parser)


def run(args: argparse.Namespace) -> int:
    # here and not above: mistakes and help are answered without them
    from ..exchange.target.controllers import for_car, write_image

    Printer(args).files(write_image(for_car(args.controller, args.vehicle, args.parameters), args.output))
    return 0
