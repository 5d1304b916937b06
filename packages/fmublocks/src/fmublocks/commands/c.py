"""Writes the C of a sampled block for a processor: NAME.h and NAME.c, its structs and arithmetic in C99 without any
FMI, which call nothing but math.h, and controller.h, the same under names that do not tell which block it is.

examples:
  fmublocks c my_controller.py
  fmublocks c my_controller.py --precision double --output firmware/controller
"""

from pathlib import Path

from toolground.argument_types import output_folder
from toolground.arguments import option, positional, record
from toolground.printing import Printing

from ..own_file import fmu_in


@record
class Arguments(Printing):
    file: Path = positional("a Python file that declares an FMU", Path, "FILE.py")
    precision: str = option("float", "of the arithmetic (default: %(default)s)", choices=("float", "double"))
    output: Path = option(Path("build/c"), "(default: %(default)s)", output_folder, metavar="FOLDER")


def run(args: Arguments) -> int:
    from toolground.atomic_files import write_texts

    from ..target.sources import PRECISIONS, target_sources

    sources = target_sources(fmu_in(args.file), PRECISIONS[args.precision])
    files = {args.output / name: text for name, text in sources.items()}
    write_texts(files)
    args.written(files)
    return 0
