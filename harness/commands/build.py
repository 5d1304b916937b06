"""Builds the FMUs of the loop, which the other commands run. The same sources give the same files, byte by byte.

A vehicle file and the gains that `driveline design` makes of it become start values: the FMUs are that car. The native
builds need a C compiler; where it is missing, they are left out unless they are asked for (docs/fmus.md).

FMUs: {fmus}
only by name, controllers to compare ours with: {comparators}

examples:
  driveline build                            all FMUs, each build that is possible here
  driveline build TwoMassDriveline --build native --output /srv/fmus
  driveline build my_vehicle.py              the block in a file of your own, see docs/fmus.md
  driveline build --vehicle car.toml --parameters gains.toml
  driveline build --platform all --fmi 3     for FMI 3.0, on Linux, Windows and macOS (extra `cross`)
"""

from pathlib import Path

from fmublocks.commands.build_options import BuildOptions
from toolground.argument_types import output_folder
from toolground.arguments import option, positional, record

from ...fmus.building.builds import build_fmus
from ...fmus.catalogue import FMUS
from ...fmus.names import COMPARATORS
from ..loop.places import BUILD
from .options import ParameterFiles

IN_HELP = {"fmus": ", ".join(FMUS), "comparators": ", ".join(COMPARATORS)}


@record
class Arguments(BuildOptions, ParameterFiles):
    names: tuple[str, ...] = positional("a name or a file of your own (default: all names)", str, "FMU", "*")
    output: Path = option(BUILD, "(default: %(default)s)", output_folder, metavar="FOLDER")


def run(args: Arguments) -> int:
    files = args.vehicle, args.parameters
    args.write(build_fmus(args.names, args.output, args.build, args.platform, *files, int(args.fmi)))
    return 0
