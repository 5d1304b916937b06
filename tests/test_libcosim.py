"""The FMUs in libcosim, a co-simulation tool that we did not write: the same loop, the same result."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from harness.master import Scheme, run
from harness.wiring import CONNECTIONS, System, loop

pytest.importorskip("libcosimpy", reason="libcosimpy has no wheel for this platform")

STEPS = 400
T_DRIVER = 60.0

# the Python package of libcosim misspells a name in its method for Integer connections
WITHOUT_COUNTER = tuple(c for c in CONNECTIONS if c.target != "controller.counter")

HOST = """
import json, sys
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave

job = json.load(sys.stdin)
execution = CosimExecution.from_step_size(1_000_000)  # ns
index = {
    name: execution.add_local_slave(CosimLocalSlave(fmu_path=path, instance_name=name))
    for name, path in job["fmus"].items()
}
reference = {
    f"{name}.{v.name.decode()}": v.reference
    for name, i in index.items() for v in execution.slave_variables(i)
}
for variable, value in job["start"].items():
    assert execution.real_initial_value(index[variable.partition(".")[0]], reference[variable], value)
for source, target, kind in job["connections"]:
    failed = getattr(execution, f"connect_{kind}_variables")(
        index[source.partition(".")[0]], reference[source], index[target.partition(".")[0]], reference[target]
    )
    assert not failed
observer = CosimObserver.create_last_value()
execution.add_observer(observer)
assert execution.step(job["steps"])
values = {}
for variable in job["outputs"]:
    (values[variable],) = observer.last_real_values(index[variable.partition(".")[0]], [reference[variable]])
print("RESULT" + json.dumps(values))
"""


def in_libcosim(system: System, start: dict[str, float], outputs: list[str], folder: Path) -> dict[str, float]:
    kinds = {"can.valid": "boolean"}
    job = {
        "fmus": {name: str(path) for name, path in system.instances.items()},
        "start": start,
        "connections": [(c.source, c.target, kinds.get(c.source, "real")) for c in system.connections],
        "steps": STEPS,
        "outputs": outputs,
    }
    done = subprocess.run(
        [sys.executable, "-c", HOST], input=json.dumps(job), capture_output=True, text=True, cwd=folder, check=False
    )
    assert done.returncode == 0, done.stderr
    (result,) = (line for line in done.stdout.splitlines() if line.startswith("RESULT"))
    return json.loads(result.removeprefix("RESULT"))


@pytest.mark.parametrize("plant", ["TwoMassDriveline", "ValidationVehicle"])
def test_libcosim_gets_what_our_master_gets_with_jacobi(plant: str, built: Path, tmp_path: Path) -> None:
    whole = loop(plant, built)
    system = System(whole.instances, WITHOUT_COUNTER, whole.inputs, whole.parameters, whole.outputs)
    start = {"plant.v_0": 5.0, "plant.T_0": 20.0}
    outputs = ["plant.T_gear", "plant.omega_1", "plant.v", "motor.T_mot", "controller.T_ref", "can.omega_2_can"]
    theirs = in_libcosim(system, {**start, "controller.T_driver": T_DRIVER}, outputs, tmp_path)
    inputs = {"controller.T_driver": T_DRIVER, "controller.enable": True, "plant.T_brake": 0.0, "plant.slope": 0.0}
    ours = run(system, STEPS * 1e-3, 1e-3, inputs, start, Scheme.JACOBI)[-1]
    for name in outputs:
        assert theirs[name] == pytest.approx(ours[name], rel=1e-9, abs=1e-9), name
