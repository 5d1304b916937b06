"""Writes the C of a controller: NAME.h and NAME.c, the structs and the arithmetic of its FMU in C99 without
any FMI, and controller.h, the same under names that do not tell which controller it is.

The values of the vehicle file and of the gains become its parameters. In single precision it needs
fabsf and sqrtf, for which a processor with a floating-point unit has instructions. docs/target.md says how a
project calls it.

examples:
  driveline target export
  driveline target export --vehicle car.toml --parameters gains.toml --output car/controller
  driveline target export --controller SpeedWashout
  driveline target export --precision double --output build/double
"""

import argparse
from contextlib import ExitStack

from ..base.errors import DrivelineError
from .options import add_controller, add_output, add_printing
from .printing import Printer


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_controller(parser)
    parser.add_argument(
        "--precision", choices=("float", "double"), default="float", help="of the arithmetic (default: %(default)s)"
    )
    add_output(parser, "build/target", "the C files", of_a_run=True)
    add_printing(parser)


def run(args: argparse.Namespace) -> int:
    # here and not above: mistakes and help are answered without them
    from ...fmus.target.sources import PRECISIONS, target_sources
    from ..base.atomic_files import complete
    from ..exchange.target.controllers import for_car
    from ..simulation.provenance import require_same_text

    fmu = for_car(args.controller, args.vehicle, args.parameters)
    sources = target_sources(fmu, PRECISIONS[args.precision])
    files = {args.output / name: text for name, text in sources.items()}
    if folder := next((path for path in files if path.is_dir()), None):
        raise DrivelineError(f"{folder} is a folder; a file is needed")
    if not args.replace:
        for path, text in files.items():
            require_same_text(text, path)
    with ExitStack() as all_or_none:
        for path, text in files.items():
            all_or_none.enter_context(complete(path)).write_text(text, encoding="utf-8")
    Printer(args).files(files)
    return 0
