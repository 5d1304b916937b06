"""The controller as plain C for a processor: single precision throughout, and the same torque as in double."""

import math
import re
import shutil
import subprocess
import sys
from pathlib import Path
from platform import machine

import numpy as np
import pytest

from tests import ROOT

pytest.importorskip("casadi", reason="the extra `native` is not installed")

from benchmarks.target import compiled, outputs, program, recorded
from benchmarks.target_cost import on_arm
from fmus.native.compiler import CompilerError
from fmus.native.statements import SINGLE
from fmus.native.target import target_sources
from fmus.two_mass_driveline import FMU as CONTINUOUS
from harness.control_loop import NATIVE
from harness.manoeuvres.catalogue import MANOEUVRES
from models.damping_controller import BLOCK as CONTROLLER

DOUBLE_INSTRUCTION = re.compile(r"v?(cvt\w*sd\w*|(add|sub|mul|div|sqrt|min|max|comi|ucomi|cmp\w*)[sp]d)|f\w+")
"""Arithmetic in double precision, conversions, and the old floating-point unit, as x86-64 disassembles."""


LONG_IN_THE_GAP = ("launch_brake",)
"""There the twist is the integral of a difference of speeds, each of them rounded; a flank that is only grazed
magnifies what that adds up to."""


@pytest.fixture(scope="module")
def programs(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    return {precision: program(precision, tmp_path_factory.mktemp(precision)) for precision in ("float", "double")}


@pytest.mark.parametrize("name", MANOEUVRES)
def test_single_precision_demands_the_same_torque(name: str, programs: dict[str, Path], both_built: Path) -> None:
    inputs = recorded(MANOEUVRES[name], both_built / NATIVE)
    single, double = (outputs(programs[precision], inputs) for precision in ("float", "double"))
    T_ref, largest = double["T_ref"], np.max(np.abs(double["T_ref"]))
    error = np.abs(single["T_ref"] - T_ref)
    close = error <= 1e-3 + 1e-4 * np.abs(T_ref)
    if name in LONG_IN_THE_GAP:
        phi_B = CONTROLLER.Parameters().phi_B
        first, second = (np.abs(each["phi_hat"]) < phi_B for each in (single, double))
        until = np.argmax(first != second)  # a flank is grazed, and reached in one of them alone
        assert np.all(error[:until] <= 1e-3 + 1e-4 * largest)
        assert np.all(error <= 5e-3 * largest)
        assert np.all(close[-500:])
    else:
        assert np.all(close)
    assert np.ptp(T_ref) > 10.0


FAULTS = {
    "motor speed lost": ("omega_1_meas", math.nan),
    "motor speed frozen": ("omega_1_meas", None),
    "torque frozen": ("T_mot_est", None),
    "wheel speed invalid": ("valid", 0.0),
    "no messages": ("counter", None),
    "wheel speed absurd": ("omega_2_can", math.inf),
}
"""Input, and what takes its place; None: what it was when the fault began."""


@pytest.mark.parametrize("fault", FAULTS)
def test_single_precision_recognises_a_fault_within_a_sample(
    fault: str, programs: dict[str, Path], both_built: Path
) -> None:
    inputs = recorded(MANOEUVRES["drive"], both_built / NATIVE)
    name, value = FAULTS[fault]
    column = CONTROLLER.Input._fields.index(name)
    inputs[1000:1200, column] = inputs[1000, column] if value is None else value
    single, double = (outputs(programs[precision], inputs)["status"] for precision in ("float", "double"))
    assert len(set(double)) > 1
    assert np.count_nonzero(single != double) <= 2, "one sample at its beginning, one at its end"


def test_in_double_precision_it_is_the_model(programs: dict[str, Path], both_built: Path) -> None:
    inputs = recorded(MANOEUVRES["launch_brake"], both_built / NATIVE)
    p = CONTROLLER.Parameters()
    expected, x = [], None
    for row in inputs.tolist():
        u = CONTROLLER.Input(*row)
        u = u._replace(valid=bool(u.valid), enable=bool(u.enable))
        x = x or CONTROLLER.start(u, p)
        expected.append(tuple(map(float, CONTROLLER.output(x, u, p))))
        x = CONTROLLER.update(x, u, p)
    found = np.array(outputs(programs["double"], inputs).tolist())
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-12)


def double_instructions(path: Path) -> list[str]:
    command = ["objdump", "-d", str(path)]
    listing = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    instructions = [line.split("\t")[2].split()[0] for line in listing.splitlines() if line.count("\t") == 2]
    return [name for name in instructions if DOUBLE_INSTRUCTION.fullmatch(name)]


@pytest.mark.skipif(machine() != "x86_64" or not shutil.which("objdump"), reason="knows the disassembly of x86-64")
def test_no_instruction_is_in_double_precision(tmp_path: Path) -> None:
    assert double_instructions(compiled("double", tmp_path))
    assert not double_instructions(compiled("float", tmp_path))


def test_the_unit_for_single_precision_of_an_arm_processor_does_it_all(tmp_path: Path) -> None:
    compiled("float", tmp_path)
    try:
        path = on_arm(tmp_path)
    except CompilerError as reason:
        pytest.skip(str(reason))
    assert not subprocess.run(["nm", "-u", path], capture_output=True, text=True, check=True).stdout


def test_the_command_writes_header_and_source(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "fmus.native.target", "--output", str(tmp_path / "c"), "--precision", "float"]
    subprocess.run(command, check=True, cwd=ROOT)
    assert sorted(path.name for path in (tmp_path / "c").iterdir()) == ["damping_controller.c", "damping_controller.h"]
    assert "double" not in (tmp_path / "c" / "damping_controller.c").read_text(encoding="utf-8")


def test_the_command_takes_the_car_and_its_gains(tmp_path: Path) -> None:
    gains = tmp_path / "gains.toml"
    gains.write_text("k_d = 4.0\n", encoding="utf-8")
    command = [sys.executable, "-m", "fmus.native.target", "--output", str(tmp_path), "--parameters", str(gains)]
    subprocess.run([*command, "--vehicle", "examples/cars/van.toml"], check=True, cwd=ROOT)
    text = (tmp_path / "damping_controller.c").read_text(encoding="utf-8")
    for line in (".k_d = 4.0f,", ".T_max = 250.0f,", ".phi_B = 0.314f,", ".omega_w = 3.0f,"):
        assert line in text
    gains.write_text("J_1 = 0.05\n", encoding="utf-8")
    refused = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert refused.returncode == 2
    assert "line 1: J_1 does not belong here" in refused.stderr


def test_only_sampled_blocks_run_on_a_target() -> None:
    with pytest.raises(ValueError, match="TwoMassDriveline is a continuous block"):
        target_sources(CONTINUOUS, SINGLE)
