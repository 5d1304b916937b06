"""What runs an FMU for the rules of what it does."""

from collections.abc import Sequence
from math import inf, sin
from typing import Any, cast

from fmpy.fmi2 import fmi2Discard
from fmpy.model_description import ModelVariable

from fmuloop.errors import SimulationError
from fmuloop.instance import Instance

Outputs = list[tuple[str, Any]]

Position = tuple[int, float, bool, dict[int, float]]
"""Step, time, whether the simulation has ended, and what is due when."""

READABLE = (
    *("Real", "Integer", "Enumeration", "Boolean", "String"),
    *("Float32", "Int8", "UInt8", "Int16", "UInt16", "UInt32", "Int64", "UInt64"),
)
"""Types whose values are compared; of FMI 3.0 not those that are binary, no arrays, and nothing that a clock makes
known in event mode alone."""


class Host:
    """An instance that is fed with small oscillations around the start values of its Real inputs.

    Attributes:
        ended: whether the FMU has ended the simulation, as FMI lets it (2.0: section 4.2.1, fmi2Terminated; 3.0:
            terminateSimulation of fmi3DoStep).
        due: of an FMU with clocks: see EventHost.
    """

    def __init__(self, instance: Instance) -> None:
        self.instance = instance
        interface = instance.interface
        default = interface.description.defaultExperiment
        self.step_size = float(default.stepSize or 1e-3) if default else 1e-3
        self.stop = float(default.stopTime or 1.0) if default else 1.0
        rates = interface.rates.values()  # of inputs that are fed; they stay at 0
        reals = [v for v in interface.of_causality("input") if v.type == "Real"]
        self.inputs = [v for v in reals if v.valueReference not in rates and not v.clocks]
        self.step, self.time, self.ended = 0, 0.0, False
        self.due: dict[int, float] = {}

    def start(self) -> None:
        """From instantiation or reset to the first step."""
        self.go_to((0, 0.0, False, {}))
        self.instance.call("start", 0.0, None)
        self._feed()
        self.instance.call("exitInitializationMode")

    def position(self) -> Position:
        """Where the run is, as far as the host knows; what goes with a saved state."""
        return self.step, self.time, self.ended, dict(self.due)

    def go_to(self, position: Position) -> None:
        """Back to such a position."""
        self.step, self.time, self.ended, due = position
        self.due = dict(due)

    def advance(self, size: float) -> Outputs:
        """Makes a communication step, unless the simulation has ended; the outputs after it."""
        if not self.ended:
            self._feed()
            self._pass(size)
        self.step, self.time = self.step + 1, self.time + size
        return self.outputs()

    def _pass(self, size: float) -> None:
        """Lets that much time pass."""
        self._step(self.time, size)

    def _step(self, time: float, size: float) -> Any:
        """What fmpy makes of the answer to a communication step; None if the simulation has ended in it."""
        try:
            return self.instance.call("doStep", time, size)
        except SimulationError:
            if self.instance.status != fmi2Discard or not cast(Any, self.instance.slave).has_ended():
                raise
            self.ended = True
            return None

    def run(self, steps: int) -> list[Outputs]:
        """Outputs at the beginning and after each step of the default size."""
        return [self.outputs(), *(self.advance(self.step_size) for _ in range(steps))]

    def outputs(self) -> Outputs:
        return self.read(self.instance.interface.of_causality("output"))

    def read(self, variables: Sequence[ModelVariable]) -> Outputs:
        """Names and values of the variables."""
        values: Outputs = []
        for kind in READABLE:
            alike = [v for v in variables if v.type == kind and not v.clocks]
            if alike:
                values += [(v.name, value) for v, value in zip(alike, self.instance.get(alike), strict=True)]
        return values

    def _feed(self) -> None:
        if self.inputs:
            self.instance.set(self.inputs, [near_start(v, sin(0.1 * self.step)) for v in self.inputs])


def near_start(variable: ModelVariable, swing: float) -> float:
    """A value by that share of a tenth of the nominal one away from the start value, within bounds."""
    value = float(variable.start or 0.0) + 0.1 * float(variable.nominal or 1.0) * swing
    return min(max(value, float(variable.min or -inf)), float(variable.max or inf))
