"""A loop in libcosim: see test_hosts.py."""

import json
import sys
from pathlib import Path

from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave

job = json.load(sys.stdin)
execution = CosimExecution.from_step_size(round(1e9 * job["step_size"]))  # ns
# its method for Integer connections calls this by another name than it was given
execution._CosimExecution__connect_integer_variables = execution._CosimExecution__connect_int_variables
index = {
    name: execution.add_local_slave(CosimLocalSlave(fmu_path=path, instance_name=name))
    for name, path in job["fmus"].items()
}
place = {
    f"{name}.{v.name.decode()}": (i, v.reference) for name, i in index.items() for v in execution.slave_variables(i)
}
for variable, value in job["start"].items():
    assert execution.real_initial_value(*place[variable], value), variable
for source, target, kind in job["connections"]:
    failed = getattr(execution, f"connect_{kind}_variables")(*place[source], *place[target])
    assert not failed, target
observer = CosimObserver.create_last_value()
execution.add_observer(observer)
assert execution.step(job["steps"])
values = {}
for variable in job["outputs"]:
    instance, reference = place[variable]
    (values[variable],) = observer.last_real_values(instance, [reference])
Path(sys.argv[1]).write_text(json.dumps(values))
