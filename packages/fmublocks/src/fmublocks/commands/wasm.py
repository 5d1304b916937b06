"""Makes a WebAssembly module of the FMU in a Python file, NAME.wasm, which imports nothing: a page or Node runs it
without any server. It exports the functions of FMI 2.0, `instantiate(name, guid, model_exchange)` in the place of the
one that takes callbacks, `last_message()`, `malloc` and `free`. It needs Zig: the extra `cross`.

examples:
  fmublocks wasm my_block.py
  fmublocks wasm my_block.py --output page
"""

from pathlib import Path

from toolground.argument_types import output_folder
from toolground.arguments import option, positional, record
from toolground.printing import Printing

from ..own_file import fmu_in


@record
class Arguments(Printing):
    file: Path = positional("a Python file that declares an FMU", Path, "FILE.py")
    output: Path = option(Path("build"), "(default: %(default)s)", output_folder, metavar="FOLDER")


def run(args: Arguments) -> int:
    from ..wasm import build_wasm

    path = build_wasm(fmu_in(args.file), args.output)
    args.say(f"{path}  {path.stat().st_size / 1024:.0f} kB")
    return 0
