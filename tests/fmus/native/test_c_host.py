"""Native FMUs in a C program, a process without any Python: the same numbers as through fmpy."""

import subprocess
from functools import cache
from pathlib import Path
from shutil import copyfile

import fmpy
import numpy as np
import pytest

from driveline.fmus.catalogue import FMUS
from driveline.fmus.native.compiler import host_compiler
from driveline.harness.loop.places import NATIVE
from driveline.models.block.types import SampledBlock
from tests.fmus.host import opened
from tests.fmus.native.legal_hosts import HOSTS, ODD_FOLDER
from tests.together import together

FMI_HEADERS = Path(fmpy.__file__).parent / "c-code"

STEPS, STEP_SIZE = 300, 1e-3

TUNED = {
    "TwoMassDriveline": "m",
    "ValidationVehicle": "m",
    "MotorTorqueLoop": "g_T",
    "WheelSpeedCan": "d_max",
    "DampingController": "Ls_T_l",
}
"""A tunable parameter of each; that it takes effect test_tunable.py says."""


def compiled(source: str, folder: Path) -> Path:
    """A program of this folder."""
    program = folder / "host"
    flags = ("-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-Wconversion", "-O1")
    path = Path(__file__).parent / source
    subprocess.run(
        [host_compiler(), *flags, f"-I{FMI_HEADERS}", path, "-o", program, "-ldl", "-lm", "-pthread"], check=True
    )
    return program


@pytest.fixture(scope="module")
def host(tmp_path_factory) -> Path:
    return compiled("host.c", tmp_path_factory.mktemp("host"))


@pytest.fixture(scope="module")
def legal_host(tmp_path_factory) -> Path:
    return compiled("legal_hosts.c", tmp_path_factory.mktemp("legal"))


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


def given(path: Path) -> list[str]:
    """What legal_hosts.c is told of an FMU."""
    description = fmpy.read_model_description(str(path))
    reals = [v for v in description.modelVariables if v.type == "Real"]
    outputs = ",".join(str(v.valueReference) for v in reals if v.causality == "output")
    first, second = [v for v in reals if v.causality == "input"][:2]
    (tunable,) = (v for v in reals if v.name == TUNED[path.stem])
    values = [
        first.valueReference,
        40.0,
        second.valueReference,
        20.0,
        tunable.valueReference,
        0.9 * float(tunable.start or "nan"),
    ]
    return [str(each) for each in (description.guid, outputs, *values)]


@together("name", FMUS)
def test_every_legal_host_gets_the_numbers_of_a_plain_one(both_built, legal_host, tmp_path, name):
    path = both_built / NATIVE / f"{name}.fmu"
    fmpy.extract(str(path), str(tmp_path / "fmu"))
    library = tmp_path / "fmu" / "binaries" / fmpy.platform / f"{name}{fmpy.sharedLibraryExtension}"
    odd = copyfile(library, (tmp_path / ODD_FOLDER).mkdir() or tmp_path / ODD_FOLDER / library.name)
    odd.chmod(0o555)
    odd.parent.chmod(0o555)
    arguments = given(path)

    @cache
    def run(options: tuple[str, ...], place: Path = library) -> np.ndarray:
        done = subprocess.run([legal_host, place, *arguments, *options], capture_output=True, check=False, cwd="/")
        assert (done.returncode, done.stderr) == (0, b""), options
        return np.array([[*map(float, line.split())] for line in done.stdout.splitlines()])

    sampled = isinstance(FMUS[name].block, SampledBlock)
    for row in HOSTS:
        found, expected = run(row.options, odd if row.folder else library), run(row.like)
        assert found.shape == (7, len(arguments[1].split(",")))
        other_steps = any(option.startswith("step") for option in row.options)
        within = 0.0 if sampled or not other_steps else 1e-5
        np.testing.assert_allclose(found, expected, rtol=within, atol=within, err_msg=row.does)
