"""The master: runs wired FMUs in step, k * step_size being the time, and records every output.

Gauss-Seidel steps one instance after the other and hands each the newest outputs: an instance that
comes later gets what those before it put out at the end of the step. Jacobi gives all of them the
outputs of the beginning of the step. What each does to the loop's dead time is in the documentation.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from enum import Enum
from math import floor, isfinite

import numpy as np
from fmpy.fmi2 import fmi2Warning
from numpy.typing import ArrayLike, NDArray

from ..errors import SimulationError, WiringError
from ..progress import chunks
from .calls import Call, advance, receives, sends
from .compiled import LIBRARY, CompiledSteps
from .instance import Instance, instantiated
from .row import Layout
from .steps import Memory, Steps, interpreted
from .system import System
from .wiring import Interface, check_interfaces

Source = ArrayLike | Callable[[NDArray[np.float64]], ArrayLike]
"""An input from outside: a constant, a sample for each instant, or a function of the instants."""


class Scheme(Enum):
    """When an output reaches the inputs it feeds."""

    GAUSS_SEIDEL = "gauss-seidel"
    JACOBI = "jacobi"


def run(
    system: System,
    duration: float,
    step_size: float = 1e-3,
    inputs: Mapping[str, Source] | None = None,
    parameters: Mapping[str, float] | None = None,
    scheme: Scheme = Scheme.GAUSS_SEIDEL,
    label: str = "simulating",
) -> np.ndarray:
    """Runs a system of FMUs.

    Args:
        duration: in s; the run ends with the last whole step.
        step_size: communication step in s.
        inputs: `instance.variable` -> signal, held over each communication step.
        parameters: `instance.variable` -> value.
        label: of the progress display.

    Returns:
        Structured array with the rows of the instants k * step_size, k = 0, 1, ..., and the columns
        `time`, each input (held from that instant on) and each output `instance.variable` (as the
        FMU gives it at the end of the step).

    Raises:
        WiringError: the FMUs do not fit together, or do not fit the inputs and parameters.
        SimulationError: an FMU refused a call.
    """
    with prepared(system, duration, step_size, inputs or {}, parameters or {}) as loop:
        loop.run(scheme, label)
        return loop.results


@contextmanager
def prepared(
    system: System,
    duration: float,
    step_size: float,
    inputs: Mapping[str, Source],
    parameters: Mapping[str, float],
) -> Iterator["Loop"]:
    """The loop before its first step; arguments and errors as for `run`. Afterwards all FMUs are gone."""
    time = instants(duration, step_size)
    interfaces = {name: Interface(path) for name, path in system.instances.items()}
    check_interfaces(system, interfaces, inputs, parameters)
    layout = Layout(interfaces, list(inputs))
    table = np.zeros(len(time), layout.dtype)
    table["time"] = time
    for name, source in inputs.items():
        table[name] = _sampled(name, source, time)
    with ExitStack() as stack:
        instances = [stack.enter_context(instantiated(*item)) for item in interfaces.items()]
        loop = Loop(system, instances, layout, table, step_size)
        loop.initialize(parameters)
        yield loop


def instants(duration: float, step_size: float) -> NDArray[np.float64]:
    """k * step_size for k = 0, 1, ... up to the duration, in s.

    Raises:
        WiringError: there is not one step to make.
    """
    if not (isfinite(duration) and isfinite(step_size) and 0.0 < step_size <= duration):
        raise WiringError(
            f"a step of {step_size:g} s in a run of {duration:g} s: steps must be longer than 0 s and "
            "not longer than the run"
        )
    return np.arange(floor(duration / step_size + 1e-6) + 1, dtype=np.float64) * step_size


def _sampled(name: str, source: Source, time: NDArray[np.float64]) -> NDArray[np.generic]:
    samples = np.asarray(source(time) if callable(source) else source)
    if samples.shape not in ((), time.shape):
        raise WiringError(f"{name} has {samples.shape} samples; the run has {len(time)} instants")
    return samples


class Loop:
    """Instances, the row of memory that connects them, and the table that the rows go to."""

    def __init__(
        self,
        system: System,
        instances: Sequence[Instance],
        layout: Layout,
        table: np.ndarray,
        step_size: float,
    ) -> None:
        self.instances = instances
        self.table = table
        self.columns = layout.results
        self.known = layout.known
        self.row = bytearray(layout.dtype.itemsize)
        self.step_size = step_size
        self.rounds = len(system.connections) + 2
        sources = {target: source for source, target in system.connections}
        given = (name for name in layout.dtype.names or () if layout.offset(name) < layout.known)
        sources |= {name: name for name in given}
        self.sends = [sends(i, _of(i.name, sources), self.row, layout) for i in instances]
        self.steps = [[advance(i, self.row, step_size)] for i in instances]
        self.receives = [receives(i, self.row, layout) for i in instances]

    @property
    def results(self) -> np.ndarray:
        """The table with truth values as such."""
        return self.table.astype(self.columns)

    def initialize(self, parameters: Mapping[str, float]) -> None:
        """Brings all instances from instantiation to the first step, with consistent outputs.

        Raises:
            SimulationError: an FMU refuses, or the outputs do not settle: an algebraic loop.
        """
        stop = float(self.table["time"][-1])
        for instance in self.instances:
            instance.set_parameters(_of(instance.name, parameters))
            instance.call("setupExperiment", startTime=0.0, stopTime=stop)
        for instance in self.instances:
            instance.call("enterInitializationMode")
        self._propagate()
        for instance in self.instances:
            instance.call("exitInitializationMode")

    def _propagate(self) -> None:
        """Outputs to inputs until nothing changes; each round settles at least one connection."""
        data = self.table.view(np.uint8).data
        self.row[: self.known] = data[: self.known]
        calls = _flat(step for pair in zip(self.sends, self.receives, strict=True) for step in pair)
        before = None
        for _ in range(self.rounds):
            for call in calls:
                _check(call, call.run(), "at the start")
            if self.row == before:
                data[: len(self.row)] = self.row
                return
            before = bytes(self.row)
        raise SimulationError("the outputs at the start do not settle: the connections form an algebraic loop")

    def run(
        self,
        scheme: Scheme,
        label: str,
        make: Callable[[Sequence[Call], Memory], Steps] = CompiledSteps if LIBRARY else interpreted,
    ) -> None:
        """Makes all steps and fills the table.

        Args:
            make: CompiledSteps or interpreted; the results are the same.

        Raises:
            SimulationError: an FMU refused a call.
        """
        phases = (self.sends, self.steps, self.receives)
        if scheme is Scheme.GAUSS_SEIDEL:
            calls = _flat(phase for instance in zip(*phases, strict=True) for phase in instance)
        else:
            calls = _flat(instance for phase in phases for instance in phase)
        steps = make(calls, Memory(self.row, self.known, self.table))
        for chunk in chunks(len(self.table) - 1, label):
            refusal = steps(chunk)
            if refusal:
                _check(refusal.call, refusal.status, f"at {self.table['time'][refusal.step]:g} s")


def _flat(groups) -> list[Call]:
    return [call for group in groups for call in group]


def _of(instance: str, values: Mapping[str, object]) -> dict:
    """The entries of `instance.variable` that belong to an instance, by variable."""
    prefix = f"{instance}."
    return {name.removeprefix(prefix): value for name, value in values.items() if name.startswith(prefix)}


def _check(call: Call, status: int, when: str) -> None:
    if status > fmi2Warning:
        raise call.instance.failure(call.function, status, when)
