"""The complete loop in a host that we did not write, against our master."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from driveline.harness.cosimulation.experiment import Experiment
from driveline.harness.cosimulation.runs import run
from driveline.harness.cosimulation.system import Scheme
from driveline.harness.loop.settings import loop

STEPS, STEP_SIZE = 400, 1e-3
T_DRIVER = 60.0
START = {"plant.v_0": 5.0, "plant.T_0": 20.0}
OUTPUTS = ("plant.T_gear", "plant.omega_1", "plant.v", "motor.T_mot", "controller.T_ref", "can.omega_2_can")
TYPES = {"can.valid": "boolean", "can.counter": "integer"}


def check_loop(script: str, plant: str, build: str, fmus: Path, folder: Path, **environment: str) -> None:
    """Fails unless a host gets what our master gets under Jacobi.

    Args:
        script: beside this file; it reads the loop as JSON and writes its last outputs to the file that it is given.
        fmus: folder of both builds.
        folder: in which the script runs.
        environment: added to that of the process.
    """
    system = loop(plant, folder=fmus, build=build)
    job = {
        "fmus": {name: str(path) for name, path in system.instances.items()},
        "start": START | {"controller.T_driver": T_DRIVER},
        "connections": [(c.source, c.target, TYPES.get(c.source, "real")) for c in system.connections],
        "steps": STEPS,
        "step_size": STEP_SIZE,
        "outputs": OUTPUTS,
    }
    answer = folder / "outputs.json"
    done = subprocess.run(
        [sys.executable, Path(__file__).with_name(script), answer],
        input=json.dumps(job),
        capture_output=True,
        text=True,
        cwd=folder,
        env=os.environ | environment,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    theirs = json.loads(answer.read_text())
    inputs = {"controller.T_driver": T_DRIVER, "controller.enable": True, "plant.T_brake": 0.0, "plant.slope": 0.0}
    ours = run(system, Experiment(STEPS * STEP_SIZE, STEP_SIZE, inputs, START, Scheme.JACOBI))[-1]
    for name in OUTPUTS:
        assert theirs[name] == pytest.approx(ours[name], rel=1e-9), name
