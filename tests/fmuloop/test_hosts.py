"""The complete loop in co-simulation tools that we did not write: what our master gets under Jacobi."""

import json
import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from driveline.harness.loop.places import BUILDS, PLANTS
from driveline.harness.loop.settings import loop
from fmuloop.experiment import Experiment
from fmuloop.runs import run
from fmuloop.system import Scheme

STEPS, STEP_SIZE = 400, 1e-3
T_DRIVER = 60.0
START = {"plant.v_0": 5.0, "plant.T_0": 20.0}
OUTPUTS = ("plant.T_gear", "plant.omega_1", "plant.v", "motor.T_mot", "controller.T_ref", "can.omega_2_can")
TYPES = {"can.valid": "boolean", "can.counter": "integer"}

LIBRARIES = {"LD_LIBRARY_PATH": str(Path(sys.prefix) / "lib")}
"""Where PyPI's tbb puts what ecos loads."""


@pytest.mark.parametrize("plant", PLANTS)
@pytest.mark.parametrize(
    ("tool", "folder", "build"),
    [
        *((tool, "both_built", build) for tool in ("libcosim", "ecos") for build in BUILDS),
        ("ecos", "fmi3_as_native", "native"),
    ],
)
def test_a_tool_gets_what_our_master_gets_with_jacobi(request, tmp_path, tool, folder, build, plant) -> None:
    """A script reads the loop as JSON and writes its last outputs to the file that it is given."""
    if find_spec(f"{tool}py") is None:
        pytest.skip(f"{tool}py is not installed")
    system = loop(plant, folder=request.getfixturevalue(folder), build=build)
    job = {
        "fmus": {name: str(path) for name, path in system.instances.items()},
        "start": START | {"controller.T_driver": T_DRIVER},
        "connections": [(c.source, c.target, TYPES.get(c.source, "real")) for c in system.connections],
        "steps": STEPS,
        "step_size": STEP_SIZE,
        "outputs": OUTPUTS,
    }
    answer = tmp_path / "outputs.json"
    command = [sys.executable, Path(__file__).with_name(f"{tool}_host.py"), answer]
    where = {"cwd": tmp_path, "env": os.environ | LIBRARIES}
    done = subprocess.run(command, input=json.dumps(job), capture_output=True, text=True, check=False, **where)
    assert done.returncode == 0, done.stdout + done.stderr
    theirs = json.loads(answer.read_text())
    inputs = {"controller.T_driver": T_DRIVER, "controller.enable": True, "plant.T_brake": 0.0, "plant.slope": 0.0}
    ours = run(system, Experiment(STEPS * STEP_SIZE, STEP_SIZE, inputs, START, Scheme.JACOBI))[-1]
    for name in OUTPUTS:
        assert theirs[name] == pytest.approx(ours[name], rel=1e-9), name
