"""The command that builds FMUs, which `build_fmus.py` and `driveline build` both are."""

from argparse import ArgumentParser, Namespace
from pathlib import Path

from ..catalogue import FMUS
from ..names import COMPARATORS
from .builds import BUILDS, FMIS, PLATFORMS, build_fmus
from .options import add_parameter_files, output_folder

DESCRIPTION = """\
Builds the FMUs of the loop, which the other commands run. The same sources give
the same files, byte by byte.

A vehicle file and the gains that `driveline design` makes of it become start values: the FMUs are that car.

They are for co-simulation with FMI 2.0; the native ones of continuous blocks are for model exchange too, in either FMI.
The native builds go into the folder native/ in that of the others. They need a C compiler;
where it is missing, they are left out unless they are asked for. With --fmi 3 the
FMUs are native ones for FMI 3.0, in the folder fmi3/.
"""


def examples(program: str) -> str:
    """How the program is called."""
    return f"""\
FMUs: {", ".join(FMUS)}
only by name, controllers to compare ours with: {", ".join(COMPARATORS)}

examples:
  {program}                            all FMUs, each build that is possible here
  {program} TwoMassDriveline           only that one
  {program} --output /srv/fmus         somewhere else
  {program} --build native             only the native ones
  {program} my_vehicle.py              the block in a file of your own, see docs/native.md
  {program} --vehicle car.toml --parameters gains.toml
  {program} --fmi 3                    for FMI 3.0
  {program} --platform all             native ones for Linux, Windows and macOS (extra `cross`)
"""


def add_arguments(parser: ArgumentParser, folder: Path) -> None:
    """Adds names, builds, platform and output folder, which is `folder` by default."""
    parser.add_argument("names", nargs="*", metavar="FMU", help="a name or a file of your own (default: all names)")
    parser.add_argument("--build", choices=BUILDS, help="which build (default: each that is possible here)")
    parser.add_argument(
        "--platform", choices=PLATFORMS, default="host", help="of the native build (default: %(default)s)"
    )
    versions = [str(fmi) for fmi in FMIS]
    parser.add_argument("--fmi", choices=versions, default=versions[0], help="2.0 or 3.0 (default: %(default)s)")
    add_parameter_files(parser)
    parser.add_argument(
        "--output", type=output_folder, default=str(folder), metavar="FOLDER", help="(default: %(default)s)"
    )
    parser.add_argument("--quiet", action="store_true", help="print only what goes wrong")


def run(args: Namespace) -> None:
    """Builds what the arguments ask for and prints the paths and sizes of the files.

    Raises:
        BuildError: see `fmus.building.builds.build_fmus`.
    """
    files = args.vehicle, args.parameters
    for path in build_fmus(args.names, args.output, args.build, args.platform, *files, int(args.fmi)):
        if not args.quiet:
            print(f"{path}  {path.stat().st_size / 1024:.0f} kB")
