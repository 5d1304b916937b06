"""What the controller takes on a processor, as a page: `python -m benchmarks.target_cost` writes docs/target.md.

Instructions are counted by valgrind, not timed. The sizes for an ARM processor need the extra `cross`.
"""

import argparse
import re
import shutil
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from fmus.builds import NATIVE_FOLDER
from fmus.damping_controller import FMU
from fmus.native.compiler import zig_compiler
from fmus.native.target import PRECISIONS
from fmus.native.trace import leaves
from harness.control_loop import BUILD
from harness.manoeuvres.catalogue import MANOEUVRES
from harness.stopping import script

from .target import FLAGS, as_text, compiled, outputs, program, recorded

PAGE = Path(__file__).parent.parent / "docs" / "target.md"

COUNTED = MANOEUVRES["tipin15"]
"""Manoeuvre over which instructions are counted."""

ARM = ("-target", "thumb-linux-musleabihf", "-mcpu=cortex_m4+vfp4d16sp", "-fno-builtin-memset")
"""A Cortex-M4 with its unit for single precision, as Zig names it; runs of zeros stay what they are."""

BYTES = {"float": 4, "double": 8}

UNWINDING = ("-fno-unwind-tables", "-fno-asynchronous-unwind-tables")

HEAD = """\
# The controller on a processor

Made by `python -m benchmarks.target_cost`; do not edit.

```sh
python -m fmus.native.target --output build/target                      # single precision
python -m fmus.native.target --output build/target --precision double
python -m fmus.native.target --vehicle car.toml --parameters gains.toml    # for a car, see control.md
```

writes `damping_controller.h` and `damping_controller.c`: C99 that needs `fabsf` and `sqrtf` of the library, allocates
nothing, has no global variable and no loop. It is the same traced arithmetic as in the FMU. A project calls it so, the
last part every 2 ms:

```c
static DampingControllerState states[2], *x = &states[0], *next = &states[1];

/* once, with the first inputs */
damping_controller_start(&u, &damping_controller_parameters, x);

/* at each sample, u holding what was measured */
damping_controller_output(x, &u, &damping_controller_parameters, &y); /* y.T_ref for the motor, by the sample before */
damping_controller_update(x, &u, &damping_controller_parameters, next);
DampingControllerState *past = x;
x = next;
next = past;
```

Parameters are declared in the header with units and meanings; a project with other values passes its own record.
Measurements that are lost may be NaN, so do not compile with `-ffast-math`.

## What it takes

"""

DISTANCES = """
Code and constants were compiled with `-O2`. RAM is two states, the inputs and the outputs; the parameters may lie in
flash. Instructions are those of `output` and `update` together on x86-64, the mean over the {counted} samples of
`{manoeuvre}`, counted with valgrind. What was compiled for the Cortex-M4 was not run; in single precision it calls no
function, so its floating-point unit does everything.

## Single against double precision

Both fed with what the controller was fed with in the loop; the largest distance during each manoeuvre:

| manoeuvre | `T_ref` (N·m) | `T_gear_hat` (N·m) | largest `T_ref` (N·m) |
|---|---|---|---|
"""

TAIL = """
Single precision rounds the estimated speeds, and the twist inside the gap is the integral of their difference, which no
measurement corrects there. In `launch_brake` the teeth float in the gap for seconds under the brakes and graze a flank.
A fault may be recognised one sample earlier or later than in double precision, as times are added up sample by sample.
"""


def sections(path: Path) -> dict[str, int]:
    """Bytes of code and of constants in an object file."""
    listing = subprocess.run(["size", "-A", path], capture_output=True, text=True, check=True).stdout
    found = re.findall(r"^\.(text|rodata)\S*\s+(\d+)", listing, re.MULTILINE)
    return {kind: sum(int(size) for name, size in found if name == kind) for kind in ("text", "rodata")}


def stack(folder: Path) -> int:
    """Bytes of stack of the hungriest function; none calls another."""
    return max(int(line.split("\t")[1]) for line in (folder / "damping_controller.su").read_text().splitlines())


def ram(precision: str) -> int:
    """Bytes of two states, the inputs and the outputs."""
    block = FMU.block
    u, p = block.Input(), block.Parameters()
    x = block.start(u, p)
    numbers = 2 * len(leaves(x)) + len(u) + len(block.output(x, u, p))
    return numbers * BYTES[precision]


def instructions(path: Path, inputs: np.ndarray) -> float:
    """Per sample."""
    counted = [f"--toggle-collect=damping_controller_{name}" for name in ("update", "output")]
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", "--collect-atstart=no", *counted]
    done = subprocess.run([*command, path], input=as_text(inputs), capture_output=True, text=True, check=True)
    (total,) = re.findall(r"Collected : (\d+)", done.stderr)
    return int(total) / len(inputs)


def on_arm(folder: Path) -> Path:
    """The object file for the ARM processor.

    Raises:
        CompilerError: the compiler is missing.
    """
    path = folder / "arm.o"
    command = [*zig_compiler(), *ARM, *FLAGS, *UNWINDING, "-c", "damping_controller.c", "-o", path.name]
    subprocess.run(command, cwd=folder, check=True)
    return path


def row(processor: str, precision: str, path: Path, others: tuple[str, str]) -> str:
    size = sections(path)
    cells = (processor, precision, f"{size['text']}", f"{size['rodata']}", f"{ram(precision)}", *others)
    return f"| {' | '.join(cells)} |\n"


def costs(precision: str, folder: Path, inputs: np.ndarray) -> str:
    """Rows of the first table."""
    path = program(precision, folder)
    counted = f"{instructions(path, inputs):.0f}" if shutil.which("valgrind") else "not counted"
    rows = row("x86-64", precision, compiled(precision, folder), (f"{stack(folder)}", counted))
    return rows + row("Cortex-M4F", precision, on_arm(folder), ("-", "-"))


def distances(single: Path, double: Path, fmus: Path) -> str:
    """Rows of the second table."""
    rows = []
    for manoeuvre in MANOEUVRES.values():
        inputs = recorded(manoeuvre, fmus)
        one, other = outputs(single, inputs), outputs(double, inputs)
        of_T_ref, of_T_gear_hat = (np.max(np.abs(one[name] - other[name])) for name in ("T_ref", "T_gear_hat"))
        largest = np.max(np.abs(other["T_ref"]))
        rows.append(f"| {manoeuvre.name} | {of_T_ref:.1g} | {of_T_gear_hat:.1g} | {largest:.0f} |\n")
    return "".join(rows)


def page(fmus: Path) -> str:
    """The page as Markdown."""
    inputs = recorded(COUNTED, fmus)
    text = HEAD + "| processor | precision | code (B) | constants (B) | RAM (B) | stack (B) | instructions a sample |\n"
    text += f"{'|---' * 7}|\n"
    with TemporaryDirectory() as temporary:
        folders = {precision: Path(temporary) / precision for precision in PRECISIONS}
        for precision, folder in folders.items():
            folder.mkdir()
            text += costs(precision, folder, inputs)
        text += DISTANCES.format(counted=len(inputs), manoeuvre=COUNTED.name)
        return text + distances(folders["float"] / "run", folders["double"] / "run", fmus) + TAIL


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.target_cost", description="Write docs/target.md.")
    parser.add_argument("--fmus", type=Path, default=BUILD / NATIVE_FOLDER, help="folder of the FMUs of the loop")
    PAGE.write_text(page(parser.parse_args().fmus), encoding="utf-8")
    print(PAGE)


if __name__ == "__main__":
    script(main)
