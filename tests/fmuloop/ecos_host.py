"""A loop in ecos: see test_hosts.py."""

import json
import os
import sys
from pathlib import Path

from ecospy import EcosSimulation
from ecospy.EcosSimulationStructure import EcosSimulationStructure

KINDS = {"real": "real", "integer": "int", "boolean": "bool"}


def identifier(variable: str) -> str:
    return variable.replace(".", "::")


job = json.load(sys.stdin)
structure = EcosSimulationStructure()
for name, path in job["fmus"].items():
    structure.add_model(name, path)
for source, target, kind in job["connections"]:
    getattr(structure, f"make_{KINDS[kind]}_connection")(identifier(source), identifier(target))
structure.add_parameter_set("start", {identifier(name): value for name, value in job["start"].items()})
simulation = EcosSimulation(job["step_size"], structure=structure)
assert simulation.init(parameter_set="start")
simulation.step(job["steps"])
values = {name: simulation.get_real(identifier(name)) for name in job["outputs"]}
simulation.terminate()
Path(sys.argv[1]).write_text(json.dumps(values))
os._exit(0)  # destroying a simulation unloads its FMUs: once, on a busy machine, a process ended in unloaded code
