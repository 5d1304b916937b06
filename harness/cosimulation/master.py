"""The master: runs wired FMUs in step, k * step_size being the time, and records every output.

What is done in which order, and when an output reaches an input, is the scheme: see schedule.py and
docs/loop.md.
"""

import logging
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from ctypes import c_double
from pathlib import Path
from typing import Any

import numpy as np
from fmpy.fmi2 import fmi2Discard, fmi2OK, fmi2Warning

from ..base.errors import SimulationError, WiringError
from ..base.progress import chunks, progress
from .bound_calls import Wires, wired
from .calls import Call
from .experiment import Experiment
from .instance import FMU2Traced, FMU3Traced, Instance, instantiated
from .parameter_changes import Change, changes, initial
from .results import Results
from .steps import NOT_FINITE, MakeSteps, Refusal, made
from .system import Scheme
from .unpacked_fmu import unpacked
from .wiring import Fit, require, unknown

LOG = logging.getLogger(__name__)


@contextmanager
def opened(fitted: Fit, folder: Path | None, make_steps: MakeSteps) -> Iterator["Loop"]:
    """The FMUs of a system, loaded into this process and wired; see `harness.cosimulation.loading.loaded`.

    Raises:
        SimulationError: an FMU cannot be loaded.
    """
    with ExitStack() as stack:
        instances = [
            stack.enter_context(instantiated(name, stack.enter_context(unpacked(interface, folder)), number))
            for number, (name, interface) in enumerate(fitted.interfaces.items())
        ]
        for instance in instances:
            instance.own = instance.name in fitted.system.own
        yield Loop(fitted, instances, make_steps)


class Loop:
    """Loaded FMUs that run together, from the beginning each time.

    Attributes:
        fitted: what they are.
        instances: they, in the order in which they step.
        ended: where an FMU has ended the last run, so many rows there are, and what is said of it.
    """

    def __init__(self, fitted: Fit, instances: Sequence[Instance], make_steps: MakeSteps) -> None:
        self.fitted = fitted
        self.instances = instances
        self._make_steps = make_steps
        self._step_size = c_double()
        self._wires: dict[tuple[Scheme, tuple[str, ...]], Wires] = {}
        self._is_new = True
        self.ended: tuple[int, str] | None = None

    def reset(self) -> None:
        """Brings all FMUs back to where they were when they had been loaded.

        Raises:
            SimulationError: one cannot; the loop is of no more use then.
        """
        if not self._is_new:
            for instance in self.instances:
                instance.reset()
        self._is_new = True

    def run(self, experiment: Experiment) -> Results:
        """Runs the FMUs from reset on, whatever the run before has done and however it has ended.

        Returns:
            Structured array with the rows of the instants k * step_size, k = 0, 1, ..., and the columns
            `time`, each input (held from that instant on) and each output `instance.variable`: under the
            propagated scheme that of the instant with the inputs of the instant, else as the FMU gives it
            at the end of the step. Where an FMU asks for the end of the run, which is said, the rows so far.

        Raises:
            WiringError: inputs or parameters do not fit the FMUs, or the scheme does not suit them.
            SimulationError: an FMU refused a call.
        """
        wires, table, due = self.begin(experiment)
        time = experiment.time()
        with progress(len(table) - 1, experiment.label) as done:
            for chunk in self._tuned(chunks(len(table) - 1), due):
                refusal = wires.steps(table, chunk)
                if refusal and _has_ended(refusal):
                    self.ended = _end(refusal, time)
                    break
                if refusal:
                    begun = refusal.status == NOT_FINITE
                    _check(refusal.call, refusal.status, float(time[refusal.step if begun else refusal.instant]))
                table.passed(len(chunk))
                done(chunk.stop)
        for instance in self.instances:
            instance.call("terminate")
        if self.ended is None:
            return wires.layout.results(table)
        rows, text = self.ended
        LOG.warning(text)
        return wires.layout.results(table[:rows])

    def begin(self, experiment: Experiment) -> tuple[Wires, Results, list[Change]]:
        """Brings the FMUs from reset to the first step; gives what they are bound to, a table with the first row, and
        the parameters that are to be changed.

        Raises:
            WiringError, SimulationError: as of `run`.
        """
        time = experiment.time()
        require(unknown(self.fitted, experiment.inputs, experiment.parameters))
        samples = self._present(experiment.samples(time))
        parameters = self._present(experiment.parameters)
        due = changes(parameters, time)
        wires = self._wired(Scheme(experiment.scheme), tuple(samples))
        table = wires.layout.table(time, samples)
        del samples  # the table has them
        self.reset()
        self._is_new, self.ended = False, None
        self._step_size.value = experiment.step_size
        self._initialize(wires, table, initial(parameters), experiment.tolerance)
        return wires, table, due

    def _tuned(self, steps: Iterable[range], due: Sequence[Change]) -> Iterator[range]:
        """The steps; before some of them parameters are set.

        Raises:
            SimulationError: an FMU refused a value.
        """
        left = list(due)
        for part in steps:
            first = part.start
            while left and left[0].step < part.stop:
                change = left.pop(0)
                if first < change.step:
                    yield range(first, change.step)
                first = change.step
                instance = next(each for each in self.instances if each.name == change.instance)
                instance.set_parameters({change.parameter: change.value})
            yield range(first, part.stop)

    def _present(self, given: Mapping[str, Any]) -> dict[str, Any]:
        """What is given without what the FMUs do not have.

        Raises:
            WiringError: that is more than they do without it.
        """
        present = dict(given)
        for name in self.fitted.absent.keys() & given.keys():
            only, value = self.fitted.absent[name], present.pop(name)
            if only is not None and np.any(value != only):
                file = self.fitted.file(name)
                raise WiringError(f"{name}: {file} does not have it and runs as if it were always {only:g}")
        return present

    def _wired(self, scheme: Scheme, inputs: tuple[str, ...]) -> Wires:
        """The calls for runs under a scheme that give these inputs, bound when they are given for the first time.

        Raises:
            WiringError: the scheme does not suit the system.
        """
        if (scheme, inputs) not in self._wires:
            fixed = self._step_size, self._make_steps
            self._wires[scheme, inputs] = wired(self.fitted, self.instances, inputs, scheme, *fixed)
        return self._wires[scheme, inputs]

    def _initialize(
        self, wires: Wires, table: np.ndarray, parameters: Mapping[str, float], tolerance: float | None
    ) -> None:
        """Brings all instances from instantiation to the first step, with consistent outputs in the first row.

        Raises:
            SimulationError: an FMU refuses, or the outputs do not settle: an algebraic loop.
        """
        stop = float(table[-1]["time"])
        for instance in self.instances:
            prefix = f"{instance.name}."
            own = {name.removeprefix(prefix): parameters[name] for name in parameters if name.startswith(prefix)}
            instance.set_parameters(own)
        for instance in self.instances:
            instance.call("start", 0.0, stop, _tolerance(instance, tolerance))
        self._propagate(wires, table)
        for instance in self.instances:
            instance.call("exitInitializationMode")
        self._propagate(wires, table, anew=False)  # some have their first outputs only now

    def _propagate(self, wires: Wires, table: np.ndarray, anew: bool = True) -> None:
        """Outputs to inputs until nothing changes; each round settles at least one connection.

        Args:
            anew: whether nothing was sent before.
        """
        data, row, known = table.view(np.uint8).data, wires.row, wires.layout.known
        if anew:
            row[:] = bytes(len(row))
            row[:known] = data[:known]
        before = None
        for _ in range(len(self.fitted.system.connections) + 2):
            for call in wires.hand_over:
                if call.changed:
                    call.changed()
                _check(call, made(call))
            if row == before:
                data[: table.itemsize] = row[: table.itemsize]
                return
            before = row[:]
        raise SimulationError("the outputs at the start do not settle: the connections form an algebraic loop")


def _tolerance(instance: Instance, given: float | None) -> float | None:
    """That of a run: the one that is given, else that of the FMU's default experiment."""
    default = instance.interface.description.defaultExperiment
    own = getattr(default, "tolerance", None)  # fmpy says not that there may be none
    return float(own) if given is None and own is not None else given


def _has_ended(refusal: Refusal) -> bool:
    """Whether the FMU has not refused its step but asked for the end of the run."""
    slave = refusal.call.instance.slave
    if refusal.status != fmi2Discard or not refusal.call.function.endswith("DoStep"):
        return False
    return isinstance(slave, FMU2Traced | FMU3Traced) and slave.has_ended()


def _end(refusal: Refusal, time: np.ndarray) -> tuple[int, str]:
    """The number of rows before it, and what is said."""
    row = refusal.step
    return row + 1, f"{refusal.call.instance.label} has ended the run at {time[row]:g} s"


def _check(call: Call, status: int, time: float | None = None) -> None:
    """Raises the error of a status at a time in s (of NaN, in the step from it on); None: before the first."""
    if status == NOT_FINITE:
        when = "at the start" if time is None else f"in the step from {time:g} s"
        raise call.instance.not_finite(call.names, call.values, when)
    if status not in (fmi2OK, fmi2Warning):
        when = "at the start" if time is None else f"at {time:g} s"
        raise call.instance.failure(call.function, status, when)
