"""A small host for the tests: variables by name, and everything the FMU logs.

An FMU of FMI 3.0 is called, and what it says is read, in the words of FMI 2.0, so that one test asks the same of both.
"""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

import fmpy
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import (
    FMU2Model,
    FMU2Slave,
    fmi2CallbackAllocateMemoryTYPE,
    fmi2CallbackFreeMemoryTYPE,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
)
from fmpy.fmi3 import _FMU3 as FMU3  # pyright: ignore[reportPrivateUsage]
from fmpy.fmi3 import FMU3Model, FMU3Slave

WORDS = {"fmi3": "fmi2", "Float64": "Real", "Int32": "Integer", "Enumeration": "Integer"} | {
    "fmi3GetContinuousStateDerivatives": "fmi2GetDerivatives",
    "fmi3UpdateDiscreteStates": "fmi2NewDiscreteStates",
    "fmi3GetOutputDerivatives": "fmi2GetRealOutputDerivatives",
}
"""Of FMI 3.0, and those of FMI 2.0 that stand for them."""

FUNCTIONS = "|".join(word for word in WORDS if word.startswith(("fmi3G", "fmi3U")))


def in_words_of_fmi2(text):
    """A message, or the name of a type."""
    known = rf"\b({FUNCTIONS}|fmi3(?=[A-Z])|(Float64|Int32|Enumeration)\b)"
    return re.sub(known, lambda match: WORDS[match[0]], text)


def of_fmi3(function: str) -> str:
    """What FMI 3.0 calls a function of FMI 2.0."""
    names = {two: three for three, two in WORDS.items()}
    return names.get(function, function.replace("fmi2", "fmi3"))


@cache
def description(path, _changed) -> Any:
    """The model description of an FMU, read once; types have the names of FMI 2.0."""
    model: Any = fmpy.read_model_description(str(path))
    for variable in model.modelVariables if model.fmiVersion == "3.0" else ():
        variable.type = variable.type if variable.type == "Enumeration" else in_words_of_fmi2(variable.type)
    return model


class AsFMU2(FMU3):
    """What fmpy makes of an FMU of FMI 3.0, with the methods that it gives one of FMI 2.0."""

    getReal, setReal = FMU3.getFloat64, FMU3.setFloat64
    getInteger, setInteger = FMU3.getInt32, FMU3.setInt32
    getEnumeration, setEnumeration = FMU3.getInt64, FMU3.setInt64
    getFMUstate, setFMUstate, freeFMUstate = FMU3.getFMUState, FMU3.setFMUState, FMU3.freeFMUState
    serializeFMUstate, deSerializeFMUstate = FMU3.serializeFMUState, FMU3.deserializeFMUState
    newDiscreteStates = FMU3.updateDiscreteStates

    def __init__(self, rates, **arguments):
        super().__init__(**arguments)
        self.rates = rates
        self.experiment = {}

    def setupExperiment(self, **experiment):
        """In FMI 3.0 entering initialization mode tells it."""
        self.experiment = {name: value for name, value in experiment.items() if name != "tolerance"}

    def enterInitializationMode(self):
        super().enterInitializationMode(**self.experiment)

    def reset(self):
        self.experiment = {}
        super().reset()

    def setRealInputDerivatives(self, vr, order, value):
        """In FMI 3.0 these are variables."""
        assert set(order) <= {1}
        self.setReal([self.rates[reference] for reference in vr], value)


class FMU3AsFMU2(AsFMU2, FMU3Slave):
    """For co-simulation."""

    getRealOutputDerivatives = FMU3Slave.getOutputDerivatives


class FMU3ModelAsFMU2(AsFMU2, FMU3Model):
    """For model exchange."""

    getDerivatives = FMU3Model.getContinuousStateDerivatives


class Host:
    """One instance of an FMU, the last message it logged, under which name, and the status of the last refusal."""

    def __init__(self, path, unpacked, name="instance", kind: Any = FMU2Slave) -> None:
        self.description = description(path, Path(path).stat().st_mtime_ns)
        moving = [v for v in self.description.modelVariables if v.derivative is not None and v.causality == "input"]
        self.variables = {v.name: v for v in self.description.modelVariables if v not in moving}
        self.message = self.named = ""
        self.status = 0
        assert self.description.coSimulation
        arguments = {
            "guid": self.description.guid,
            "unzipDirectory": str(unpacked),
            "modelIdentifier": self.description.coSimulation.modelIdentifier,
            "instanceName": name,
        }
        if self.description.fmiVersion == "3.0":
            as_fmu2 = FMU3ModelAsFMU2 if kind is FMU2Model else FMU3AsFMU2
            self.fmu: Any = as_fmu2({v.derivative.valueReference: v.valueReference for v in moving}, **arguments)
            self.fmu.instantiate(logMessage=lambda *logged: self._keep(None, b"", *logged[1:]), loggingOn=True)
            return
        self._callbacks = fmi2CallbackFunctions()
        self._callbacks.logger = fmi2CallbackLoggerTYPE(self._keep)
        self._callbacks.allocateMemory = fmi2CallbackAllocateMemoryTYPE(fmpy.calloc)
        self._callbacks.freeMemory = fmi2CallbackFreeMemoryTYPE(fmpy.free)
        self.fmu = kind(**arguments)
        self.fmu.instantiate(callbacks=self._callbacks, loggingOn=True)

    def _keep(self, _environment, name, _status, _category, message):
        """Without the line that PythonFMU puts before a message of ours."""
        self.named = name.decode()
        self.message = message.decode().rpartition("\n")[2]
        if self.description.fmiVersion == "3.0":
            self.message = in_words_of_fmi2(self.message)

    def names(self, causality):
        return [v.name for v in self.variables.values() if v.causality == causality]

    def _function(self, verb, name):
        kind = self.variables[name].type
        is_integer = kind == "Enumeration" and self.description.fmiVersion == "2.0"
        return getattr(self.fmu, verb + ("Integer" if is_integer else kind))

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
def opened(path, folder, name="instance", kind: Any = FMU2Slave) -> Iterator[Any]:
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


def instance(folder: str, name: str) -> Any:
    """A fixture: an instance of the FMU in the folder that another fixture makes."""

    @pytest.fixture
    def fixture(request, tmp_path):
        with opened(request.getfixturevalue(folder) / f"{name}.fmu", tmp_path) as host:
            yield host

    return fixture
