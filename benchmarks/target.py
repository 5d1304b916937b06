"""The controller's C for a target, compiled for this machine and fed with what the loop fed the controller."""

import subprocess
from pathlib import Path

import numpy as np

from fmus.damping_controller import FMU
from fmus.native.compiler import host_compiler
from fmus.native.target import PRECISIONS, target_sources
from harness.control_loop import CONNECTIONS
from harness.manoeuvres.manoeuvre import Manoeuvre
from harness.simulate import signals, simulate
from models.block.declaration import variables
from models.controller.supervision import T_S

STEP_SIZE = 1e-3
"""Communication step of the loop in s."""

DRIVER = Path(__file__).parent / "target_run.c"

FLAGS = (
    *("-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-Wconversion", "-Wdouble-promotion"),
    *("-ffp-contract=off", "-O2"),
)


def compiled(precision: str, folder: Path) -> Path:
    """Writes the controller's C into the folder and compiles it there: an object file, and how much stack it takes.

    Args:
        precision: one of PRECISIONS.

    Raises:
        CompilerError: there is no compiler.
        subprocess.CalledProcessError: it refuses the source.
    """
    for name, text in target_sources(FMU, PRECISIONS[precision]).items():
        (folder / name).write_text(text, encoding="utf-8")
    command = [host_compiler(), *FLAGS, "-fstack-usage", "-c", "damping_controller.c"]
    subprocess.run(command, cwd=folder, check=True)
    return folder / "damping_controller.o"


def program(precision: str, folder: Path) -> Path:
    """The controller as a program that reads inputs and writes outputs, see target_run.c; errors as for `compiled`."""
    files = [compiled(precision, folder), DRIVER]
    path = folder / "run"
    command = [host_compiler(), *FLAGS, f"-DREAL={precision}", f"-I{folder}", *map(str, files), "-lm", "-o", str(path)]
    subprocess.run(command, check=True)
    return path


def recorded(manoeuvre: Manoeuvre, fmus: Path, control: bool = True) -> np.ndarray:
    """What the controller gets in the closed loop: a row a sample, a column an input, in the order of its record.

    Args:
        fmus: folder of the built FMUs.
    """
    every = round(T_S / STEP_SIZE)
    results = simulate(manoeuvre, control=control, step_size=STEP_SIZE, folder=fmus)[::every]
    sources = {name: name for name in signals(manoeuvre)} | {target: source for source, target, _ in CONNECTIONS}
    names = [variable.name for variable in variables(FMU.block.Input)]
    return np.column_stack([np.asarray(results[sources[f"controller.{name}"]], float) for name in names])


def as_text(inputs: np.ndarray) -> str:
    """The rows as the program reads them."""
    return "".join(" ".join(map(repr, row)) + "\n" for row in inputs.tolist())


def outputs(path: Path, inputs: np.ndarray) -> np.ndarray:
    """Structured array of what the program at `path` answers to the inputs."""
    done = subprocess.run([path], input=as_text(inputs), capture_output=True, text=True, check=True)
    record = [(variable.name, float) for variable in variables(FMU.block.Output)]
    return np.array([tuple(map(float, line.split())) for line in done.stdout.splitlines()], dtype=record)
