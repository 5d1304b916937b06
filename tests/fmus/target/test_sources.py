"""The controller as plain C for a processor: single precision throughout, and the same torque as in double."""

import math
import re
import shutil
import subprocess
from functools import cache
from pathlib import Path
from platform import machine

import numpy as np
import pytest
from fmutesting.slow import slow
from fmutesting.together import together

from driveline.fmus.catalogue import CONTROLLERS, FMUS
from driveline.harness.exchange.target.comparison import responses
from driveline.harness.exchange.target.offline_cases import Case, recorded
from driveline.harness.loop.resolved import as_given
from driveline.harness.loop.settings import Settings
from driveline.harness.manoeuvres.catalogue import MANOEUVRES, USUAL_MANOEUVRES
from driveline.models.controller import T_S
from driveline.models.damping_controller import BLOCK as CONTROLLER
from fmublocks.block.declaration import Enumeration
from fmublocks.description.variables import interface
from fmublocks.errors import BuildError
from fmublocks.native.compiler import CompilerError, host_compiler
from fmublocks.native.statements import SINGLE
from fmublocks.target.image import FLAGS, host_program
from fmublocks.target.link import Link
from fmublocks.target.sources import PRECISIONS, target_sources

OURS = CONTROLLERS["DampingController"]

DOUBLE_INSTRUCTION = re.compile(r"v?(cvt\w*sd\w*|(add|sub|mul|div|sqrt|min|max|comi|ucomi|cmp\w*)[sp]d)|f\w+")
"""Arithmetic in double precision, conversions, and the old floating-point unit, as x86-64 disassembles."""


@pytest.fixture(scope="module")
def programs(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    return {
        name: host_program(target_sources(OURS, precision), tmp_path_factory.mktemp(name))
        for name, precision in PRECISIONS.items()
    }


@cache
def fed(name: str, fmus: Path) -> Case:
    """What the controller gets in a manoeuvre; to be copied where it is changed."""
    settings = Settings(folder=fmus, build="native")
    return recorded(MANOEUVRES[name], as_given(settings), CONTROLLER.Input._fields)


def outputs(programs: dict[str, Path], precision: str, inputs: np.ndarray) -> np.ndarray:
    """Structured array of what a program answers to the inputs."""
    link = Link([str(programs[precision])], precision, precision[0])
    rows = [answer.outputs for answer in responses(link, Case("", CONTROLLER.Input._fields, inputs))]
    return np.array(rows, dtype=[(name, float) for name in CONTROLLER.Output._fields])


@pytest.mark.parametrize(
    "name", slow([each.name for each in USUAL_MANOEUVRES], but=["launch_brake", "tipin15", "drive"])
)
def test_single_precision_demands_the_same_torque(name: str, programs: dict[str, Path], both_built: Path) -> None:
    """Also in `launch_brake`, where the teeth float for seconds and the twist is the integral of a rounded speed."""
    inputs = fed(name, both_built).inputs
    single, double = (outputs(programs, precision, inputs)["T_ref"] for precision in ("float", "double"))
    assert np.all(np.abs(single - double) <= 1e-3 + 1e-4 * np.abs(double))
    assert np.ptp(double) > 10.0


FAULTS = {
    "motor speed lost": ("omega_1_meas", math.nan),
    "motor speed frozen": ("omega_1_meas", None),
    "torque frozen": ("T_mot_est", None),
    "wheel speed invalid": ("valid", 0.0),
    "no messages": ("counter", None),
    "wheel speed absurd": ("omega_2_can", math.inf),
}
"""Input, and what takes its place; None: what it was when the fault began."""


@together("fault", FAULTS)
def test_single_precision_recognises_a_fault_within_a_sample(
    fault: str, programs: dict[str, Path], both_built: Path
) -> None:
    inputs = fed("drive", both_built).inputs[:2500].copy()  # to a second after the damping is back
    name, value = FAULTS[fault]
    column = CONTROLLER.Input._fields.index(name)
    inputs[1000:1200, column] = inputs[1000, column] if value is None else value
    single, double = (outputs(programs, precision, inputs)["status"] for precision in ("float", "double"))
    assert len(set(double)) > 1
    assert np.count_nonzero(single != double) <= 2, "one sample at its beginning, one at its end"


def test_in_double_precision_it_is_the_model(programs: dict[str, Path], both_built: Path) -> None:
    inputs = fed("launch_brake", both_built).inputs
    p = CONTROLLER.Parameters()
    expected, x = [], None
    for row in inputs.tolist():
        u = CONTROLLER.Input(*row)
        u = u._replace(valid=bool(u.valid), enable=bool(u.enable), slip_control=bool(u.slip_control))
        x = x or CONTROLLER.start(u, p)
        expected.append(tuple(map(float, CONTROLLER.output(x, u, p))))
        x = CONTROLLER.update(x, u, p)
    found = np.array(outputs(programs, "double", inputs).tolist())
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-12)


def double_instructions(path: Path) -> list[str]:
    command = ["objdump", "-d", str(path)]
    listing = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    instructions = [line.split("\t")[2].split()[0] for line in listing.splitlines() if line.count("\t") == 2]
    return [name for name in instructions if DOUBLE_INSTRUCTION.fullmatch(name)]


@pytest.mark.skipif(machine() != "x86_64" or not shutil.which("objdump"), reason="knows the disassembly of x86-64")
def test_no_instruction_is_in_double_precision(tmp_path: Path) -> None:
    found = {}
    for name, precision in PRECISIONS.items():
        for file, text in target_sources(OURS, precision).items():
            (tmp_path / file).write_text(text, encoding="utf-8")
        subprocess.run([host_compiler(), *FLAGS, "-c", "damping_controller.c"], cwd=tmp_path, check=True)
        found[name] = double_instructions(tmp_path / "damping_controller.o")
    assert found["double"]
    assert not found["float"]


@together("name", CONTROLLERS)
def test_every_controller_compiles_under_the_names_of_any(name: str, tmp_path: Path) -> None:
    sources = target_sources(CONTROLLERS[name], SINGLE)
    for file, text in sources.items():
        (tmp_path / file).write_text(text, encoding="utf-8")
    (tmp_path / "any.c").write_text(ANY, encoding="utf-8")
    (source,) = [file for file in sources if file.endswith(".c")]
    subprocess.run([host_compiler(), *FLAGS, source, "any.c", "-lm", "-o", "any"], cwd=tmp_path, check=True)
    printed = subprocess.run([tmp_path / "any"], capture_output=True, text=True, check=True).stdout.split()
    assert printed == [name, str(T_S), "12"]


ANY = """
#include "controller.h"
#include <stdio.h>
static ControllerState x, next;
int main(void)
{
    ControllerInput u = {.T_driver = 12};
    ControllerOutput y;
    controller_start(&u, &controller_parameters, &x);
    controller_update(&x, &u, &controller_parameters, &next);
    controller_output(&x, &u, &controller_parameters, &y);
    printf("%s %g %g\\n", CONTROLLER_NAME, (double)CONTROLLER_SAMPLE_TIME, (double)y.T_ref);
    return 0;
}
"""


def test_only_sampled_blocks_run_on_a_target() -> None:
    with pytest.raises(BuildError, match="TwoMassDriveline is a continuous block"):
        target_sources(FMUS["TwoMassDriveline"], SINGLE)


def test_what_the_compiler_refuses_is_told_as_it_says_it(tmp_path: Path) -> None:
    with pytest.raises(CompilerError, match=r"wrong\.c.*\n(.*\n)*.*nothing"):
        host_program({"wrong.c": "int value(void) { return nothing; }\n"}, tmp_path)


def test_enumerations_have_the_numbers_of_the_fmu() -> None:
    header = target_sources(OURS, SINGLE)["damping_controller.h"]
    listed = [v.declaration.items for v in interface(CONTROLLER) if isinstance(v.declaration, Enumeration)]
    found = re.findall(r"DAMPING_CONTROLLER_(\w+) += (\d+),", header)
    assert found == [(name.upper(), str(k)) for items in listed for k, (name, _) in enumerate(items, start=1)]
