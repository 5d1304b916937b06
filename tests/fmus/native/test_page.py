"""The pages on FMUs: the example of a block is built and driven in the loop, the lines for FMPy run."""

import os
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from benchmarks.host_table import LINES, PACKAGES
from driveline.fmus.building.builds import build_fmus
from driveline.harness.loop.places import NATIVE
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.metrics.evaluate import evaluate
from driveline.harness.simulation.simulate import simulate
from fmublocks.errors import BuildError
from fmublocks.own_file import fmu_in
from tests import ROOT


def python_of(page: str, beginning: str = "") -> list[str]:
    return re.findall(rf"```python\n({beginning}.*?)```", (ROOT / "docs" / page).read_text(encoding="utf-8"), re.S)


(EXAMPLE,) = python_of("fmus.md")
EXCHANGE, LINEAR = python_of("native.md")
(CONTROLLER,) = python_of("control.md", '"""')


def build(file: Path, folder: Path, *options: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "build_fmus.py", *options, "--output", str(folder), str(file)]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def vehicle(both_built: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The FMU of the example."""
    folder = tmp_path_factory.mktemp("own")
    file = folder / "my_vehicle.py"
    file.write_text(EXAMPLE, encoding="utf-8")
    done = build(file, folder)
    assert done.returncode == 0, done.stderr
    return folder / NATIVE / "MyVehicle.fmu"


def test_a_vehicle_of_the_users_own_is_damped_in_the_loop(vehicle: Path, both_built: Path) -> None:
    tipin = MANOEUVRES["tipin15"]
    damped, free = (
        evaluate(simulate(tipin, vehicle, control=control, folder=both_built), tipin) for control in (True, False)
    )
    assert free.settling_time > 1.0
    assert damped.settling_time < 0.2


def test_it_gains_the_speed_that_its_masses_let_it(vehicle: Path, both_built: Path) -> None:
    given = {"plant.c_rr": 0.0, "plant.c_wa": 0.0}
    results = simulate(MANOEUVRES["tipin15"], vehicle, control=False, parameters=given, folder=both_built)
    i, r, m, J_1 = 9.0, 0.29, 1450.0, 0.055
    momentum = (m * r / i) * results["plant.v"] + J_1 * results["plant.omega_1"]
    impulse = np.trapezoid(results["motor.T_mot"], results["time"])
    # the motor's torque is held over each step of 1 ms, not moved along a line
    assert momentum[-1] - momentum[0] == pytest.approx(impulse, rel=2e-4)


OF_THE_BUS = (
    "from driveline import Fmu\nfrom driveline.models.wheel_speed_can import BLOCK\nFMU = Fmu(BLOCK, stop_time=11.0)\n"
)


def test_a_file_can_be_changed_and_read_again(tmp_path: Path) -> None:
    file = tmp_path / "my_bus.py"
    for stop_time in ("11.0", "120.0"):
        file.write_text(OF_THE_BUS.replace("11.0", stop_time), encoding="utf-8")
        assert fmu_in(file).stop_time == float(stop_time)
    del sys.modules["my_bus"]


def test_fmus_of_one_name_do_not_overwrite_each_other(tmp_path: Path) -> None:
    file = tmp_path / "my_bus.py"
    file.write_text(OF_THE_BUS, encoding="utf-8")
    with pytest.raises(BuildError, match="WheelSpeedCan is an FMU of the project"):
        list(build_fmus(["WheelSpeedCan", str(file)], tmp_path))
    del sys.modules["my_bus"]
    assert not list(tmp_path.rglob("*.fmu"))


@pytest.mark.slow
def test_a_block_of_ones_own_with_the_name_of_one_of_the_project_is_refused(tmp_path: Path) -> None:
    """It would run in the place of that one."""
    for name in ("DampingController", "SpeedWashout"):
        file = tmp_path / "my_controller.py"
        file.write_text(CONTROLLER.replace('"MyController"', f'"{name}"'), encoding="utf-8")
        done = build(file, tmp_path, "--build", "native")
        assert done.returncode == 2
        assert f"{name} is an FMU of the project" in done.stderr
        assert not list(tmp_path.rglob("*.fmu"))


@pytest.mark.slow
def test_a_controller_of_the_users_own_damps(both_built: Path, tmp_path: Path) -> None:
    """That of the page on the controller."""
    file = tmp_path / "my_controller.py"
    file.write_text(CONTROLLER, encoding="utf-8")
    done = build(file, tmp_path)
    assert done.returncode == 0, done.stderr
    controller = tmp_path / NATIVE / "MyController.fmu"
    tipin = MANOEUVRES["tipin15"]
    damped, free = (
        evaluate(simulate(tipin, controller=str(controller), control=control, folder=both_built), tipin)
        for control in (True, False)
    )
    assert damped.overshoot < 0.7 * free.overshoot


def line_of(piece: str) -> int:
    """Of the example, from 1 on."""
    return EXAMPLE[: EXAMPLE.index(piece)].count("\n") + 1


@pytest.mark.parametrize(
    ("name", "text", "builds", "message"),
    [
        ("nothing", "BLOCK = None\n", "native", "has no line `FMU = Fmu(BLOCK, stop_time=10.0)`"),
        ("leaves", "raise SystemExit(0)\n", "native", "cannot be run: SystemExit: 0"),
        ("json", EXAMPLE, "native", "there is a module called json"),
        (
            "my_vehicle",
            EXAMPLE,
            "python",
            "line 10: driveline: the Python build of a block has the standard library and fmublocks alone",
        ),
        (
            "my_vehicle",
            EXAMPLE,
            "both",
            "line 10: driveline: the Python build of a block has the standard library and fmublocks alone",
        ),
        ("my_vehicle", "import nonsense", "native", "my_vehicle.py, line 1: it cannot be run: ModuleNotFoundError: No"),
        ("my_vehicle", "\nFMU = (", "native", "my_vehicle.py, line 2: it cannot be run: SyntaxError"),
        (
            *("my_vehicle", EXAMPLE.replace("p.r * braking_force", "p.s * braking_force"), "native"),
            f"line {line_of('p.r * braking_force')}: MyVehicle cannot be built: AttributeError",
        ),
        (
            *("my_vehicle", EXAMPLE.replace("operators.tanh(x.v / p.v_rr)", "(x.v > 0.0 and 1.0)"), "native"),
            f"line {line_of('operators.tanh(x.v / p.v_rr)')}: MyVehicle cannot be built: `x.v > 0.0 and 1.0` is known",
        ),
    ],
)
def test_what_is_wrong_with_a_file_is_said_in_one_line(
    tmp_path: Path, name: str, text: str, builds: str, message: str
) -> None:
    file = tmp_path / f"{name}.py"
    file.write_text(text, encoding="utf-8")
    done = build(file, tmp_path, "--build", builds)
    assert done.returncode == 2
    assert message in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("lines", "answer"),
    [
        pytest.param(
            LINES["FMPy"] + EXCHANGE.replace("result =", "exchanged =") + "print(exchanged['v'][-1])", None, id="speeds"
        ),
        pytest.param(LINEAR, 7.69, id="frequency"),
    ],
)
def test_the_lines_for_fmpy_run(both_built: Path, tmp_path: Path, lines: str, answer: float | None) -> None:
    """Co-simulation and model exchange gain the same speed; the linear plant swings as the page says."""
    (tmp_path / "build").symlink_to(both_built)
    done = subprocess.run([sys.executable, "-c", lines], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    first, *others = map(float, done.stdout.split())
    if answer:
        assert first == pytest.approx(answer, abs=0.005)
    else:
        assert first > 11.0
        assert others == pytest.approx([first], rel=1e-6)


@pytest.mark.parametrize(
    ("tool", "other", "within"),
    [
        ("libcosim", {}, 1e-12),
        ("ecos", {}, 1e-12),
        ("OMSimulator", {}, 1e-9),
        ("pathsim", {}, 2e-4),  # a step more
        ("pathsim", {"CoSimulationFMU": "ModelExchangeFMU"}, 1e-8),
        ("FMUContainer", {}, 1e-12),
        ("FMUContainer", {"build/native": "build/fmi3"}, 1e-12),
        ("PyFMI", {}, 1e-9),
    ],
)
def test_the_lines_for_a_tool_give_the_speed_of_fmpy(
    both_built: Path, fmi3: Path, tmp_path: Path, tool: str, other: dict[str, str], within: float
) -> None:
    if find_spec(PACKAGES[tool]) is None:
        pytest.skip(f"{PACKAGES[tool]} is not installed")
    (tmp_path / "build").mkdir()
    (tmp_path / "build" / "native").symlink_to(both_built / "native")
    (tmp_path / "build" / "fmi3").symlink_to(fmi3)
    environment = os.environ | {"LD_LIBRARY_PATH": str(Path(sys.prefix) / "lib")}
    speeds = []
    for lines in (LINES["FMPy"], LINES[tool]):
        for old, new in other.items():
            lines = lines.replace(old, new)
        command = [sys.executable, "-c", lines]
        done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        speeds.append(float(re.findall(r"([\d.]+)\]?\s*$", done.stdout)[-1]))
    assert speeds[1] == pytest.approx(speeds[0], rel=within)
