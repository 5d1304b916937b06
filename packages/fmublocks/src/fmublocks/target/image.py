"""The program with the controller behind a link, compiled for the target and, to compare, for this machine; the FMU
with that image in it, and the A2L description of the image."""

import shutil
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from toolground.child_process import output_of

from ..description import a2l
from ..fmu import Fmu
from ..native.compiler import CompilerError, host_compiler, run_compiler
from ..native.statements import SINGLE
from ..python.packaging import build
from .link import EMULATOR
from .sources import target_sources

C_FILES = Path(__file__).parent / "c"

COMPILER = "arm-none-eabi-gcc"

PACKAGES = ("gcc-arm-none-eabi", "libnewlib-arm-none-eabi", "qemu-system-arm")
"""Of Debian and Ubuntu: the compiler, its C library and the emulator."""

PROCESSOR = ("-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16")

WARNINGS = ("-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-Wconversion", "-Wdouble-promotion")

CODE = (
    # each operation rounds on its own, as on this machine; nothing looks at errno
    *("-ffp-contract=off", "-fno-math-errno"),
    # small, and no choice is written as two conditional moves, which is longer than a branch
    *("-Os", "-fno-if-conversion", "-fno-if-conversion2"),
    # fewer jumps: blocks are laid out as at -O2, in the order of the C, and ends that are alike stay where they are
    *("-freorder-blocks-algorithm=stc", "-fno-guess-branch-probability", "-fno-tree-tail-merge"),
    # fewer numbers that wait on the stack: what is cheap is computed where it is needed
    *("-fno-tree-coalesce-vars", "-fno-tree-fre", "-fno-ssa-phiopt"),
    # the sign of a zero decides nothing here
    "-fno-signed-zeros",
)

FLAGS = (*WARNINGS, *CODE)

BARE = ("-nostartfiles", "--specs=nano.specs", "-Wl,--gc-sections", "-Wl,-Map=controller.map")

LINK, SCHEDULER = "link.c", "scheduler.c"
"""Programs with the controller: behind a link, and at every interrupt of a timer."""

BOARD, HOST = ("board.h", "board_mps2.c", "mps2_an386.ld"), ("board.h", "board_host.c")

A2L_RECORDS = {"parameter": "calibration", "input": "u", "output": "y"}
"""By causality the record of link.c that holds such variables, all of single precision, one after the other."""


def target_image(sources: Mapping[str, str], folder: Path, program: str = LINK) -> Path:
    """The image for the emulated target, in the folder with its sources, the objects made of them (NAME.o), how much
    stack these take (NAME.su), and controller.map.

    Args:
        sources: those of `fmus.target.sources`, in single precision.
        program: LINK or SCHEDULER.

    Raises:
        CompilerError: there is no compiler, or it refuses the source.
    """
    require_packages()
    files = written(sources, (program, *BOARD), folder)
    for name in files:
        run_compiler([COMPILER, *PROCESSOR, *FLAGS, "-fstack-usage", "-ffunction-sections", "-c", name], folder)
    objects = [name.replace(".c", ".o") for name in files]
    script = [f"-T{name}" for name in BOARD if name.endswith(".ld")]
    run_compiler([COMPILER, *PROCESSOR, *BARE, *script, *objects, "-o", "controller.elf"], folder)
    return folder / "controller.elf"


def host_program(sources: Mapping[str, str], folder: Path) -> Path:
    """The same program for this machine, whose link is its standard input and output; errors as for `target_image`."""
    files = written(sources, (LINK, *HOST), folder)
    run_compiler([host_compiler(), *FLAGS, *files, "-lm", "-o", "controller"], folder)
    return folder / "controller"


def require_packages(*others: str) -> None:
    """
    Args:
        others: programs that are needed as well, by the names of their packages.

    Raises:
        CompilerError: the compiler, its library, the emulator or another is not installed; the text says what to
            install.
    """
    lacking = [program for program in (COMPILER, EMULATOR, *others) if shutil.which(program) is None]
    if not lacking and not Path(output_of(COMPILER, "-print-file-name=nano.specs")).is_absolute():
        lacking = ["nano.specs"]
    if lacking:
        raise CompilerError(f"there is no {' and no '.join(lacking)}: apt-get install {' '.join((*PACKAGES, *others))}")


def written(sources: Mapping[str, str], others: tuple[str, ...], folder: Path) -> list[str]:
    """Writes all files into the folder; returns the names of those that are compiled."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in {**sources, **{name: (C_FILES / name).read_text(encoding="utf-8") for name in others}}.items():
        (folder / name).write_text(text, encoding="utf-8")
    return [name for name in (*sources, *others) if name.endswith(".c")]


def build_on_target(fmu: Fmu, folder: Path) -> Path:
    """Builds `folder/<name>.fmu` with the image in it, replacing one that is there, and returns its path.

    The host needs the emulator and, as for every FMU that runs Python, Python 3.11 or later in its process.

    Raises:
        CompilerError: the compiler or the emulator is missing.
    """
    with TemporaryDirectory(prefix="fmublocks-") as temporary:
        image = target_image(target_sources(fmu, SINGLE), Path(temporary)).read_bytes()
    return build(replace(fmu, image=image), folder)


def a2l_description(fmu: Fmu, image: Path) -> str:
    """The A2L file for the controller in a linked image of `target_image`.

    Args:
        fmu: of that controller.
    """
    addresses = symbols(image)
    first = {causality: addresses[record] for causality, record in A2L_RECORDS.items()}
    return a2l.description(fmu, a2l.in_order(fmu.block, first, a2l.SINGLE), a2l.SINGLE)


def symbols(image: Path) -> Mapping[str, int]:
    """The addresses of what an image holds by name."""
    listing = output_of("arm-none-eabi-nm", image)
    rows = [line.split() for line in listing.splitlines()]
    return {row[2]: int(row[0], 16) for row in rows if len(row) == 3}
