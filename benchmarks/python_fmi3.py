"""What PythonFMU3 makes of the functions of FMI 3.0, beside our native build: why there is no Python build of FMI 3.0.

An FMU for co-simulation and model exchange is packed by it. Each function that answers with a status is called in each
mode, with sizes of 0, in a process of its own, which it may end. Needs `pip install pythonfmu3`, and for the second row
`driveline build --fmi 3`.
"""

import ctypes
import os
import re
from collections.abc import Callable
from functools import partial
from importlib.metadata import version
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import fmpy
from fmpy.fmi3 import FMU3Model, FMU3Slave

from driveline.harness.loop.places import BUILD, PLANTS
from toolground.interruption import script

BLOCK = """
from pythonfmu3 import CoSimulation, Float64, Fmi3Causality, Fmi3Slave, Fmi3Variability, ModelExchange

class Relay(Fmi3Slave, CoSimulation, ModelExchange):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.time = self.u = self.y = 0.0
        continuous = Fmi3Variability.continuous
        self.register_variable(Float64("time", causality=Fmi3Causality.independent, variability=continuous))
        self.register_variable(Float64("u", causality=Fmi3Causality.input, start=0.0))
        self.register_variable(Float64("y", causality=Fmi3Causality.output))

    def do_step(self, current_time, step_size):
        return True

    def get_continuous_state_derivatives(self):
        return []
"""

HEADER = next((Path(fmpy.__file__).parent).rglob("fmi3Functions.h")).read_text(encoding="utf-8")

WITHOUT = "Instantiate|GetVersion|FreeInstance|FMUState"

FUNCTIONS = [name for name in re.findall(r"FMI3_Export \w+\s+(\w+);", HEADER) if not re.search(WITHOUT, name)]
"""Those that answer with a status, but for those on a saved state, which need one."""

CALLS = ("enterInitializationMode", "exitInitializationMode", "updateDiscreteStates", "enterContinuousTimeMode")

MODES = [(FMU3Slave, 0), (FMU3Slave, 1), (FMU3Slave, 2), (FMU3Model, 2), (FMU3Model, 4)]
"""Instantiated, initialization, step, event and continuous-time mode: how many of the calls lead there."""


def called(make: Callable[..., Any], calls: int, function: str) -> int:
    """The status that the function answers in that mode, or minus the signal that has ended the process."""
    child = os.fork()
    if not child:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        fmu = make()
        fmu.instantiate()
        for call in CALLS[:calls]:
            getattr(fmu, call)()
        given = getattr(fmu.dll, function)
        rooms = [ctypes.create_string_buffer(4096) for _ in given.argtypes]
        arguments = [
            ctypes.cast(room, kind) if issubclass(kind, (ctypes._Pointer, ctypes.c_void_p)) else 0
            for room, kind in zip(rooms, given.argtypes, strict=True)
        ]
        os._exit(given(fmu.component, *arguments[1:]))
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def row(title: str, path: Path) -> str:
    """How many of the functions of an FMU end the process in every mode."""
    description = fmpy.read_model_description(str(path), validate=False)
    given = {"guid": description.guid, "instanceName": "called"}
    given["modelIdentifier"] = getattr(description.coSimulation, "modelIdentifier", "")
    with TemporaryDirectory() as files:
        given["unzipDirectory"] = fmpy.extract(str(path), files)
        ended = [
            name for name in FUNCTIONS if all(called(partial(make, **given), calls, name) < 0 for make, calls in MODES)
        ]
    return f"{title}: {len(ended)} of {len(FUNCTIONS)} functions end the process {' '.join(ended)}"


def main() -> None:
    from pythonfmu3.builder import FmuBuilder  # pyright: ignore[reportMissingImports]

    with TemporaryDirectory() as folder:
        source = Path(folder, "relay.py")
        source.write_text(BLOCK, encoding="utf-8")
        print(row(f"PythonFMU3 {version('pythonfmu3')}", FmuBuilder.build_FMU(source, dest=folder)))
    if (native := BUILD / "fmi3" / f"{PLANTS[0]}.fmu").is_file():
        print(row("our native build", native))


if __name__ == "__main__":
    script(main)
