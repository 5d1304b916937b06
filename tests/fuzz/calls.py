"""Calls to native FMUs, in any order and with any arguments, under the address and undefined-behaviour sanitizers."""

import subprocess
from collections.abc import Iterator
from pathlib import Path
from random import Random

import fmpy
from fmpy.model_description import ModelDescription

from driveline.fmus.catalogue import FMUS
from fmublocks.builds import FMIS, NotPossible, builders
from fmublocks.native.compiler import host_compiler
from fmublocks.native.packaging import FMI_HEADERS
from tests.fuzz.target import Attempt, Unclean, target

HOST = Path(__file__).parents[1] / "fmus" / "native" / "native_host.c"

AS_FMI2 = HOST.parent / "fmi3"
"""The functions of FMI 2.0 as those of FMI 3.0, for this host."""

CALLS = 300
"""Of a sequence."""

SANITIZED = (
    *("-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-Wconversion"),
    "-ffp-contract=off",
    *("-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-g", "-O1"),
)


def numbers(description: ModelDescription) -> list[str]:
    """What the compiler is to define for a host of an FMU: numbers of states and event indicators; none: it has no
    model exchange."""
    if not description.modelExchange:
        return []
    states, indicators = description.numberOfContinuousStates, description.numberOfEventIndicators
    return [f"-DNUMBER_OF_STATES={states}", f"-DNUMBER_OF_INDICATORS={indicators}"]


def as_fmi2(description: ModelDescription) -> list[str]:
    """Options of a compiler, with which a program that calls FMI 2.0 calls this FMU of FMI 3.0; none for FMI 2.0."""
    if description.fmiVersion == "2.0":
        return []
    time = next(v.valueReference for v in description.modelVariables if v.causality == "independent")
    return [f"-DTIME={time}u", "-Wno-strict-prototypes", f"-I{AS_FMI2}", f"-I{FMI_HEADERS}"]


def program(fmu: Path, folder: Path, host: Path = HOST) -> list[str]:
    """The command of a host that makes calls to a native FMU, compiled with the sources of the FMU.

    Raises:
        NotPossible: the compiler has no sanitizers.
    """
    fmpy.extract(str(fmu), str(folder))
    sources = folder / "sources"
    made = folder.resolve() / host.stem
    description = fmpy.read_model_description(str(fmu))
    options = [*SANITIZED, *numbers(description), *as_fmi2(description)]
    command = [host_compiler(), *options, "-I.", str(host.resolve()), "all.c", "-o", str(made), "-lm"]
    compiled = subprocess.run(command, cwd=sources, capture_output=True, text=True, check=False)
    if "cannot find" in compiled.stderr:
        raise NotPossible("the compiler has no sanitizers")
    if compiled.returncode:
        raise Unclean(compiled.stderr)
    return [str(made), str(description.guid)]


@target(
    "calls of native FMUs in any order with any arguments, under address and undefined-behaviour sanitizers",
    "no fault of memory or arithmetic, no memory left behind",
    short=100,
    long=100_000,
)
def attempts(folder: Path) -> Iterator[Attempt]:
    built = [build(fmu, folder) for fmi in FMIS for build in builders("native", fmi=fmi) for fmu in FMUS.values()]
    programs = [program(fmu, folder / f"{fmu.parent.name}_{fmu.stem}") for fmu in built]

    def attempt(random: Random) -> str:
        command = [*random.choice(programs), str(random.getrandbits(31)), str(CALLS)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            raise Unclean(f"{' '.join(command)}: {done.stdout}{done.stderr}")
        return f"sequences of {CALLS} calls, no fault of memory or arithmetic"

    yield attempt
