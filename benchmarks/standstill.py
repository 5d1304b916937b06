"""What standing costs against rolling: `python -m benchmarks.standstill`, the plants alone, as native FMUs.

Standing is with a held brake and motor torque. The contenders take turns and their time is that of the processor;
the least of all turns is shown.
"""

import argparse
from collections import defaultdict
from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time

import fmpy
from fmpy.fmi2 import FMU2Slave
from rich.console import Console
from rich.table import Table

from driveline.harness.loop.places import BUILD, PLANTS
from fmublocks.builds import NATIVE_FOLDER
from toolground.interruption import script

DURATION, STEP_SIZE = 10.0, 1e-3
"""In s."""

ROLLING = "rolling"

CONTENDERS: dict[str, Mapping[str, float]] = {
    ROLLING: {"v_0": 10.0, "T_mot": 50.0},
    "rolling fast": {"v_0": 40.0, "T_mot": 150.0},
    "standing, 1500 N.m": {"T_mot": 100.0, "T_brake": 1500.0},
    "standing, 20 kN.m": {"T_mot": 100.0, "T_brake": 20000.0},
    "standing on a slope": {"slope": 0.1, "T_brake": 1500.0},
    "standing, short bristles": {"T_mot": 100.0, "T_brake": 1500.0, "z_br": 1e-4},
}


def milliseconds(fmu: Path, folder: str, values: Mapping[str, float]) -> float:
    """Of the processor for a simulated second."""
    description = fmpy.read_model_description(str(fmu))
    references = {variable.name: variable.valueReference for variable in description.modelVariables}
    assert description.coSimulation
    name = description.coSimulation.modelIdentifier
    slave = FMU2Slave(guid=description.guid, unzipDirectory=folder, modelIdentifier=name, instanceName=name)
    slave.instantiate()
    slave.setReal([references[name] for name in values], list(values.values()))
    slave.setupExperiment(startTime=0.0)
    slave.enterInitializationMode()
    slave.exitInitializationMode()
    began = process_time()
    for k in range(round(DURATION / STEP_SIZE)):
        slave.doStep(k * STEP_SIZE, STEP_SIZE)
    seconds = process_time() - began
    slave.freeInstance()
    return 1e3 * seconds / DURATION


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.standstill", description=__doc__)
    parser.add_argument("--repetitions", type=int, default=5, help="turns of each (default: %(default)s)")
    repetitions = parser.parse_args().repetitions
    for plant in PLANTS:
        fmu, turns = BUILD / NATIVE_FOLDER / f"{plant}.fmu", defaultdict(list)
        with TemporaryDirectory() as folder:
            fmpy.extract(str(fmu), folder)
            for _ in range(repetitions):
                for name, values in CONTENDERS.items():
                    turns[name].append(milliseconds(fmu, folder, values))
        table = Table("", "ms a simulated second", "over rolling", title=plant)
        for name, times in turns.items():
            table.add_row(name, f"{min(times):.1f}", f"{min(times) / min(turns[ROLLING]):.2f}")
        Console().print(table)


if __name__ == "__main__":
    script(main)
