"""`driveline build`: makes the FMUs of the project."""

import argparse
from pathlib import Path

from fmus.builds import BUILDS, PLATFORMS, NotPossible, builders
from fmus.catalogue import FMUS

from ..cosimulation.system import BUILD
from ..errors import DrivelineError
from ..names import nearest

NAME = "build"
HELP = "build the FMUs"

DESCRIPTION = """\
Builds the FMI 2.0 co-simulation FMUs of the loop, which the other commands run. The same sources give
the same files, byte by byte.

The native builds go into the folder native/ in that of the others. They need the extra `native` and a
C compiler; where one of them is missing, they are left out unless they are asked for.
"""

EXAMPLES = """\
examples:
  driveline build                          all FMUs
  driveline build TwoMassDriveline         only that one
  driveline build --output /srv/fmus       somewhere else
  driveline build --build python           only those that run Python
  driveline build --platform all           native ones for Linux, Windows and macOS (extra `cross`)
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("names", nargs="*", metavar="FMU", help="which to build (default: all)")
    parser.add_argument("--output", type=Path, default=BUILD, metavar="FOLDER", help="(default: %(default)s)")
    parser.add_argument("--build", choices=BUILDS, help="which build (default: each that is possible here)")
    parser.add_argument(
        "--platform", choices=PLATFORMS, default="host", help="of the native build (default: %(default)s)"
    )


def run(args: argparse.Namespace) -> int:
    for name in args.names:
        if name not in FMUS:
            raise DrivelineError(f"unknown FMU {name}; {nearest(name, FMUS)}")
    try:
        chosen = builders(args.build, args.platform)
    except NotPossible as reason:
        raise DrivelineError(str(reason)) from reason
    for name in dict.fromkeys(args.names or FMUS):
        for build in chosen:
            path = build(FMUS[name], args.output)
            print(f"{path}  {path.stat().st_size / 1024:.0f} kB")
    return 0
