"""`driveline build`: makes the FMUs of the project."""

import argparse
from pathlib import Path

from ..errors import DrivelineError
from ..names import nearest
from ..wiring import BUILD

NAME = "build"
HELP = "build the FMUs"

DESCRIPTION = """\
Builds the FMI 2.0 co-simulation FMUs of the loop, which the other commands run. The same sources give
the same files, byte by byte.
"""

EXAMPLES = """\
examples:
  driveline build                          all FMUs
  driveline build TwoMassDriveline         only that one
  driveline build --output /srv/fmus       somewhere else
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.description, parser.epilog = DESCRIPTION, EXAMPLES
    parser.add_argument("names", nargs="*", metavar="FMU", help="which to build (default: all)")
    parser.add_argument("--output", type=Path, default=BUILD, metavar="FOLDER", help="(default: %(default)s)")


def run(args: argparse.Namespace) -> int:
    # here and not above: only building needs the models and pythonfmu
    from fmus.catalogue import FMUS
    from fmus.packaging import build

    for name in args.names:
        if name not in FMUS:
            raise DrivelineError(f"unknown FMU {name}; {nearest(name, FMUS)}")
    for name in dict.fromkeys(args.names or FMUS):
        path = build(FMUS[name], args.output)
        print(f"{path}  {path.stat().st_size / 1024:.0f} kB")
    return 0
