"""Builds FMUs of the blocks in Python files. The same sources give the same files, byte by byte.

A file declares its FMU in the line `FMU = Fmu(BLOCK, stop_time=10.0)`. A native FMU is compiled code, which needs no
Python where it runs; to build it takes a C compiler (or the extra `cross`, which has Zig). A Python build carries the
block and needs Python 3.11 or later in the host. Native FMUs go to native/ of the folder, those of FMI 3.0 to fmi3/.

examples:
  fmublocks build my_block.py
  fmublocks build my_block.py --build both --output /srv/fmus
  fmublocks build my_block.py --fmi 3 --platform all    for FMI 3.0, on Linux, Windows and macOS (extra `cross`)
"""

from pathlib import Path

from toolground.arguments import option, positional, record

from ..builds import BUILDS, build_fmus
from ..own_file import fmu_in
from .build_options import BuildOptions


@record
class Arguments(BuildOptions):
    files: tuple[Path, ...] = positional("a Python file that declares an FMU", Path, "FILE.py", "+")
    build: str = option("native", "which build (default: %(default)s)", choices=BUILDS)


def run(args: Arguments) -> int:
    fmus = [fmu_in(path) for path in args.files]
    args.write(build_fmus(fmus, args.output, args.build, args.platform, int(args.fmi)))
    return 0
