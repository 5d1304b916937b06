"""FMUs of every build in a C program that does what the standard allows, in each of many ways: the same numbers."""

import subprocess
from functools import cache
from pathlib import Path
from shutil import copytree
from typing import Any

import fmpy
import numpy as np
import pytest
from fmpy.model_description import ModelDescription
from fmutesting import legal_hosts
from fmutesting.legal_hosts import HOSTS, LASTS, LONG, LONG_IN_PYTHON, LONGER
from fmutesting.libpython import with_libpython
from fmutesting.together import together

from driveline.fmus.catalogue import FMUS
from fmublocks.block.types import SampledBlock
from fmublocks.native.compiler import host_compiler
from tests.fuzz.calls import as_fmi2

FMI_HEADERS = Path(fmpy.__file__).parent / "c-code"
FLAGS = ("-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-Wconversion", "-O1")

TUNED = {
    "TwoMassDriveline": "m",
    "ValidationVehicle": "m",
    "MotorTorqueLoop": "g_T",
    "WheelSpeedCan": "d_max",
    "DampingController": "Ls_T_l",
}
"""A tunable parameter of each; that it takes effect test_tunable.py says."""

INSTANTS = 7


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("legal") / "host"
    source = Path(legal_hosts.__file__).with_suffix(".c")
    libraries = ("-ldl", "-lm", "-pthread")
    subprocess.run([host_compiler(), *FLAGS, f"-I{FMI_HEADERS}", source, "-o", made, *libraries], check=True)
    return made


def library_of(unpacked: Path, description: ModelDescription) -> Path:
    """What a program in the folder loads: for FMI 3.0 a library with the functions of FMI 2.0 that calls the FMU."""
    name = f"{description.modelName}{fmpy.sharedLibraryExtension}"
    if description.fmiVersion == "2.0":
        return unpacked / "binaries" / fmpy.platform / name
    (unpacked / "bridge.c").write_text('#include "fmi2Functions.h"\n')
    options = ("-std=c99", "-shared", "-fPIC", "-Dstatic=", "-Dinline=", *as_fmi2(description))
    fmu = Path("binaries") / fmpy.platform_tuple / name
    subprocess.run([host_compiler(), *options, "bridge.c", fmu, "-o", "bridge.so"], check=True, cwd=unpacked)
    return unpacked / "bridge.so"


def variables(description: ModelDescription) -> list[str]:
    """What the program is told of them."""
    reals = [v for v in description.modelVariables if v.type in ("Real", "Float64") and v.causality != "independent"]
    outputs = ",".join(str(v.valueReference) for v in reals if v.causality == "output")
    first, second = [v for v in reals if v.causality == "input" and not v.derivative][:2]
    (tunable,) = (v for v in reals if v.name == TUNED[str(description.modelName)])
    start = float(tunable.start or "nan")
    told = (first.valueReference, 40.0, second.valueReference, 20.0, tunable.valueReference, 0.9 * start, start)
    return [outputs, *map(str, told)]


LASTING = pytest.mark.parametrize("lasting", [False, pytest.param(True, marks=pytest.mark.slow)])


@LASTING
@pytest.mark.parametrize("build", ["native", "fmi3"])
@together("name", FMUS)
def test_every_legal_host_gets_the_numbers_of_a_plain_one(
    request: Any, program: Path, tmp_path: Path, name: str, build: str, lasting: bool
) -> None:
    require_same_numbers(request, program, tmp_path, name, build, lasting)


@LASTING
@pytest.mark.slow
@together("name", ["ValidationVehicle", "DampingController"])
def test_every_legal_host_gets_the_numbers_of_a_plain_one_from_python_too(
    request: Any, program: Path, tmp_path: Path, name: str, lasting: bool
) -> None:
    """One of each kind: what answers the calls is the same for all blocks of a kind, and takes a third of a second to
    begin."""
    require_same_numbers(request, program, tmp_path, name, "built", lasting)


def require_same_numbers(request: Any, program: Path, tmp_path: Path, name: str, build: str, lasting: bool) -> None:
    """That all HOSTS get the numbers of those that they are like."""
    path = request.getfixturevalue(build) / f"{name}.fmu"
    description = fmpy.read_model_description(str(path))
    unpacked, odd = tmp_path / "fmu", tmp_path / "nur lesbar, für Ähnliches"
    fmpy.extract(str(path), str(unpacked))
    copytree(unpacked, odd)
    libraries = {folder: library_of(folder, description) for folder in (unpacked, odd)}
    for each in (*odd.rglob("*"), odd):
        each.chmod(0o555)
    in_python = build == "built"
    environment = with_libpython() if in_python else {}
    longest = LONG_IN_PYTHON if in_python else LONGER.get(name, LONG) if build == "native" else LONG
    lasts = f"{LASTS}={longest}"

    @cache
    def run(options: tuple[str, ...], folder: Path = unpacked, *, has_resources: bool = True) -> np.ndarray:
        resources = folder / "resources"
        place = resources.as_uri() if description.fmiVersion == "2.0" else f"{resources}/"
        told = [str(description.guid), place if has_resources else "", *variables(description)]
        command = [program, libraries[folder], *told, *(lasts if each == LASTS else each for each in options)]
        done = subprocess.run(command, capture_output=True, check=False, cwd=folder, env=environment)
        assert (done.returncode, done.stderr) == (0, b""), options
        return np.array([[*map(float, line.split())] for line in done.stdout.splitlines()])

    sampled = isinstance(FMUS[name].block, SampledBlock)
    for row in HOSTS:
        if (LASTS in row.options) != lasting or (in_python and row.unpacked == "nowhere"):
            continue
        folder = odd if row.unpacked == "in an odd folder" else unpacked
        found, expected = run(row.options, folder, has_resources=row.unpacked != "nowhere"), run(row.like)
        assert len(found) == INSTANTS - ("inputs=none" in row.options)
        other_steps = any(option.startswith("step") for option in row.options)
        within = 0.0 if sampled or not other_steps else 1e-5
        np.testing.assert_allclose(found, expected[-len(found) :], rtol=within, atol=within, err_msg=row.does)
