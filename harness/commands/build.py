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

from contextlib import closing
from pathlib import Path

from fmublocks.builds import BUILDS, FMI3_FOLDER, FMIS, PLATFORMS
from fmublocks.origin import NATIVE_FOLDER
from toolground.argument_types import output_folder
from toolground.arguments import option, positional, record
from toolground.atomic_files import unchanged_if_stopped
from toolground.printing import Printing

from ...fmus.building.builds import build_fmus
from ...fmus.catalogue import FMUS
from ...fmus.names import COMPARATORS
from ..loop.places import BUILD
from .options import ParameterFiles

IN_HELP = {"fmus": ", ".join(FMUS), "comparators": ", ".join(COMPARATORS)}


@record
class Arguments(ParameterFiles, Printing):
    names: tuple[str, ...] = positional("a name or a file of your own (default: all names)", str, "FMU", "*")
    build: str | None = option(None, "which build (default: each that is possible here)", choices=BUILDS)
    platform: str = option("host", "of the native build (default: %(default)s)", choices=PLATFORMS)
    fmi: str = option(str(FMIS[0]), "2.0 or 3.0 (default: %(default)s)", choices=[str(fmi) for fmi in FMIS])
    output: Path = option(BUILD, "(default: %(default)s)", output_folder, metavar="FOLDER")


def run(args: Arguments) -> int:
    files = args.vehicle, args.parameters
    built = build_fmus(args.names, args.output, args.build, args.platform, *files, int(args.fmi))
    folders = (args.output / folder for folder in ("", NATIVE_FOLDER, FMI3_FOLDER))
    made: list[Path] = []
    try:
        with unchanged_if_stopped("*.fmu", *folders), closing(built):
            made.extend(built)
    except KeyboardInterrupt:
        made.clear()
        raise
    finally:  # of one that cannot be built the others stay
        for path in made:
            args.say(f"{path}  {path.stat().st_size / 1024:.0f} kB")
    return 0
