"""A small host for the tests: variables by name, and everything the FMU logs."""

from contextlib import contextmanager
from functools import cache
from pathlib import Path

import fmpy
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import (
    FMU2Slave,
    fmi2CallbackAllocateMemoryTYPE,
    fmi2CallbackFreeMemoryTYPE,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
)


@cache
def description(path, _changed):
    """The model description of an FMU, read once."""
    return fmpy.read_model_description(str(path))


class Host:
    """One instance of an FMU, the last message it logged, under which name, and the status of the last refusal."""

    def __init__(self, path, unpacked, name="instance", kind=FMU2Slave):
        self.description = description(path, Path(path).stat().st_mtime_ns)
        self.variables = {v.name: v for v in self.description.modelVariables}
        self.message = self.named = ""
        self.status = 0
        self._callbacks = fmi2CallbackFunctions()
        self._callbacks.logger = fmi2CallbackLoggerTYPE(self._keep)
        self._callbacks.allocateMemory = fmi2CallbackAllocateMemoryTYPE(fmpy.calloc)
        self._callbacks.freeMemory = fmi2CallbackFreeMemoryTYPE(fmpy.free)
        assert self.description.coSimulation
        self.fmu = kind(
            guid=self.description.guid,
            unzipDirectory=str(unpacked),
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName=name,
        )
        self.fmu.instantiate(callbacks=self._callbacks, loggingOn=True)

    def _keep(self, _environment, name, _status, _category, message):
        """Without the line that PythonFMU puts before a message of ours."""
        self.named = name.decode()
        self.message = message.decode().rpartition("\n")[2]

    def names(self, causality):
        return [v.name for v in self.variables.values() if v.causality == causality]

    def _function(self, verb, name):
        kind = self.variables[name].type
        return getattr(self.fmu, verb + ("Integer" if kind == "Enumeration" else kind))

    def set(self, **values):
        for name, value in values.items():
            self._function("set", name)([self.variables[name].valueReference], [value])

    def get(self, name):
        return self._function("get", name)([self.variables[name].valueReference])[0]

    def outputs(self):
        return {name: self.get(name) for name in self.names("output")}

    def initialize(self, start_time=0.0, stop_time=None, **values):
        """Sets parameters and inputs, and goes through initialization mode."""
        self.set(**values)
        self.fmu.setupExperiment(startTime=start_time, stopTime=stop_time)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def step(self, time, step_size):
        self.fmu.doStep(currentCommunicationPoint=time, communicationStepSize=step_size)

    def refuses(self, call, *arguments, **named):
        """The message with which the FMU refuses a call; fails if it does not."""
        with pytest.raises(FMICallException) as refusal:
            call(*arguments, **named)
        self.status = refusal.value.status
        return self.message


@contextmanager
def opened(path, folder, name="instance", kind=FMU2Slave):
    """An instance of the FMU, what it needs to run unpacked into the folder if that is empty, and freed at the end.

    Args:
        kind: FMU2Slave for co-simulation, FMU2Model for model exchange.
    """
    folder = folder.resolve()
    folder.mkdir(exist_ok=True)
    if not any(folder.iterdir()):
        fmpy.extract(str(path), str(folder), include=lambda entry: not entry.startswith(("sources/", "documentation/")))
    host = Host(path, folder, name, kind)
    try:
        yield host
    finally:
        host.fmu.freeInstance()
