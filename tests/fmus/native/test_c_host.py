"""Native FMUs in a C program, a process without any Python: the same numbers as through fmpy."""

import subprocess
from pathlib import Path

import fmpy
import pytest
from fmutesting.host import opened
from fmutesting.together import together

from driveline.fmus.catalogue import FMUS
from driveline.harness.loop.places import NATIVE
from fmublocks.native.compiler import host_compiler

FMI_HEADERS = Path(fmpy.__file__).parent / "c-code"

STEPS, STEP_SIZE = 300, 1e-3


@pytest.fixture(scope="module")
def host(tmp_path_factory) -> Path:
    program = tmp_path_factory.mktemp("host") / "host"
    flags = ("-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-Wconversion", "-O1")
    source = Path(__file__).with_name("host.c")
    subprocess.run([host_compiler(), *flags, f"-I{FMI_HEADERS}", source, "-o", program, "-ldl"], check=True)
    return program


def through_fmpy(path: Path, folder: Path, outputs: list[int]) -> list[list[float]]:
    """What host.c does, up to the end of its first run."""
    with opened(path, folder) as host:
        host.initialize()
        rows = [list(host.fmu.getReal(outputs))]
        for k in range(STEPS):
            host.fmu.setReal([0], [-40.0 if k // 50 % 2 else 40.0])
            host.step(k * STEP_SIZE, STEP_SIZE)
            rows.append(list(host.fmu.getReal(outputs)))
    return rows


@together("name", FMUS)
def test_a_c_program_gets_what_fmpy_gets_twice(both_built, host, tmp_path, name):
    folder = tmp_path / "unpacked"
    path = both_built / NATIVE / f"{name}.fmu"
    description = fmpy.read_model_description(str(path))
    outputs = [v.valueReference for v in description.modelVariables if v.causality == "output" and v.type == "Real"]
    expected = through_fmpy(path, folder, outputs)
    library = folder / "binaries" / fmpy.platform / f"{name}{fmpy.sharedLibraryExtension}"
    arguments = [library, description.guid, "", STEPS, STEP_SIZE, 0, *outputs]
    done = subprocess.run([host, *map(str, arguments)], capture_output=True, text=True, env={}, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    first, second = ([[*map(float, line.split())] for line in run.splitlines()] for run in done.stdout.split("again\n"))
    assert first == second == expected


def test_the_c_program_has_no_python(host):
    needed = subprocess.run(["ldd", host], capture_output=True, text=True, check=True).stdout
    assert "libc.so" in needed
    assert "python" not in needed
