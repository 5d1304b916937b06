"""What runs an FMU for the rules of what it does."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from math import inf, sin
from typing import Any, cast

from fmpy.fmi2 import fmi2Discard
from fmpy.model_description import ModelVariable

from ...base.errors import SimulationError
from ...cosimulation.instance import Instance, instantiated
from ...cosimulation.unpacked_fmu import Unpacked

Outputs = list[tuple[str, Any]]

READABLE = (
    *("Real", "Integer", "Enumeration", "Boolean", "String"),
    *("Float32", "Int8", "UInt8", "Int16", "UInt16", "UInt32", "Int64", "UInt64"),
)
"""Types whose values are compared; of FMI 3.0 not those that are binary, and no arrays."""


class Host:
    """An instance that is fed with small oscillations around the start values of its Real inputs.

    Attributes:
        ended: whether the FMU has ended the simulation, as FMI lets it (2.0: section 4.2.1, fmi2Terminated; 3.0:
            terminateSimulation of fmi3DoStep).
    """

    def __init__(self, instance: Instance) -> None:
        self.instance = instance
        interface = instance.interface
        default = interface.description.defaultExperiment
        self.step_size = float(default.stepSize or 1e-3) if default else 1e-3
        self.stop = float(default.stopTime or 1.0) if default else 1.0
        rates = interface.rates.values()  # of inputs that are fed; they stay at 0
        reals = [v for v in interface.of_causality("input") if v.type == "Real"]
        self.inputs = [v for v in reals if v.valueReference not in rates]
        self.step, self.time, self.ended = 0, 0.0, False

    def start(self) -> None:
        """From instantiation or reset to the first step."""
        self.step, self.time, self.ended = 0, 0.0, False
        self.instance.call("start", 0.0, None)
        self._feed()
        self.instance.call("exitInitializationMode")

    def advance(self, size: float) -> Outputs:
        """Makes a communication step, unless the simulation has ended; the outputs after it."""
        if not self.ended:
            self._feed()
            self._step(size)
        self.step, self.time = self.step + 1, self.time + size
        return self.outputs()

    def _step(self, size: float) -> None:
        try:
            self.instance.call("doStep", self.time, size)
        except SimulationError:
            if self.instance.status != fmi2Discard or not cast(Any, self.instance.slave).has_ended():
                raise
            self.ended = True

    def run(self, steps: int) -> list[Outputs]:
        """Outputs at the beginning and after each step of the default size."""
        return [self.outputs(), *(self.advance(self.step_size) for _ in range(steps))]

    def outputs(self) -> Outputs:
        return self.read(self.instance.interface.of_causality("output"))

    def read(self, variables: Sequence[ModelVariable]) -> Outputs:
        """Names and values of the variables."""
        values: Outputs = []
        for kind in READABLE:
            alike = [v for v in variables if v.type == kind]
            if alike:
                values += [(v.name, value) for v, value in zip(alike, self.instance.get(alike), strict=True)]
        return values

    def _feed(self) -> None:
        values = []
        for v in self.inputs:
            swing = 0.1 * float(v.nominal or 1.0) * sin(0.1 * self.step)
            values.append(min(max(float(v.start or 0.0) + swing, float(v.min or -inf)), float(v.max or inf)))
        if values:
            self.instance.set(self.inputs, values)


@contextmanager
def hosted(fmu: Unpacked, name: str = "checked") -> Iterator[Host]:
    with instantiated(name, fmu) as instance:
        yield Host(instance)
        instance.call("terminate")
