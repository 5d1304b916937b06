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
from fmpy.fmi2 import fmi2Discard, fmi2Error, fmi2OK, fmi2Warning

from toolground.progress import chunks, progress

from .bound_calls import Wires, wired
from .calls import Call
from .errors import RunEnded, SimulationError, WiringError
from .experiment import Experiment
from .instance import FMU2Traced, FMU3Traced, Instance, instantiated
from .parameter_changes import Change, changes, initial
from .results import Ended, Results
from .steps import NOT_FINITE, MakeSteps, Refusal, status_of
from .system import Scheme
from .unpacked_fmu import unpacked
from .wiring import Fit, require, unknown

LOG = logging.getLogger(__name__)

KEPT = "the results are kept"
"""Said of an FMU that fails after the run."""

REFUSED = (fmi2Discard, fmi2Error)
"""What a step is refused with after which a reset is allowed."""


@contextmanager
def opened(fitted: Fit, folder: Path | None, make_steps: MakeSteps) -> Iterator["Loop"]:
    """The FMUs of a system, loaded into this process and wired; see `fmuloop.loading.loaded`.

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
        ended: which FMU has ended the last run and when; None: none.
        remarks: what is to be said of the last run.
    """

    def __init__(self, fitted: Fit, instances: Sequence[Instance], make_steps: MakeSteps) -> None:
        self.fitted = fitted
        self.instances = instances
        self._make_steps = make_steps
        self._step_size = c_double()
        self._wires: dict[Any, Wires] = {}
        self._is_new = True
        self._own_steps: dict[str, float] = {}
        self.ended: Ended | None = None
        self.remarks: list[str] = []

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
            at the end of the step. Where an FMU asks for the end of the run, the rows so far; see `Results.ended`.

        Raises:
            WiringError: inputs or parameters do not fit the FMUs, or the scheme does not suit them.
            SimulationError: an FMU refused a call, or ended the run in its first step.
        """
        results = self.rows(experiment)
        for text in self.finish():
            LOG.warning(text)
        return results

    def rows(self, experiment: Experiment) -> Results:
        """As `run`, before the FMUs are told that it is over."""
        time = experiment.time()
        self.remarks = []
        while True:
            wires, table, due = self.begin(experiment)
            refusal = self._steps(experiment, wires, table, due)
            if refusal is None:
                return self._made(wires.layout.results(table))
            instance, ends = refusal.call.instance, _has_ended(refusal)
            begun = refusal.status == NOT_FINITE
            failure = _failure(refusal.call, refusal.status, float(time[refusal.step if begun else refusal.instant]))
            if self._takes_longer_steps(refusal, experiment.step_size):
                continue
            unfit = _unfit(refusal, experiment.step_size)
            if not ends:
                raise type(failure)(f"{failure}{unfit}")
            if refusal.step < self._multiples().get(instance.name, 1):
                label = instance.label
                raise RunEnded(f"{label} ended the run in its first step: there is nothing to evaluate{unfit}")
            self.ended = Ended(instance.label, float(time[refusal.step]))
            return self._made(wires.layout.results(table[: refusal.step + 1]))

    def _made(self, results: Results) -> Results:
        results.ended, results.own_steps = self.ended, self.own_steps()
        return results

    def own_steps(self) -> dict[str, float]:
        """In s, of the FMUs that make others than the loop."""
        return {name: self._own_steps[name] for name, number in self._multiples().items() if number > 1}

    def _multiples(self) -> dict[str, int]:
        """How many steps of the loop one step of those FMUs takes."""
        return {name: _multiple(own, self._step_size.value) or 1 for name, own in self._own_steps.items()}

    def finish(self) -> list[str]:
        """Tells the FMUs that the run is over; what is to be said of it, also of one that refuses that."""
        for instance in self.instances:
            try:
                instance.call("terminate")
            except SimulationError as refusal:
                self.remarks.append(f"{refusal}; {KEPT}")
        return self.remarks

    def _steps(self, experiment: Experiment, wires: Wires, table: Results, due: Sequence[Change]) -> Refusal | None:
        with progress(len(table) - 1, experiment.label) as done:
            for chunk in self._tuned(chunks(len(table) - 1), due):
                if refusal := wires.steps(table, chunk):
                    return refusal
                table.passed(len(chunk))
                done(chunk.stop)
        return None

    def _takes_longer_steps(self, refusal: Refusal, step_size: float) -> bool:
        """Whether somebody else's FMU that refuses its first step has one of its own, some of the loop's long, which it
        makes from now on."""
        instance, own = refusal.call.instance, _own_step(refusal.call.instance)
        if not refusal.call.function.endswith("DoStep") or refusal.step > 0 or refusal.status not in REFUSED:
            return False
        if instance.own or instance.name in self._own_steps or _multiple(own, step_size) < 2:
            return False
        self._own_steps[instance.name] = own
        self.remarks.append(
            f"{instance.label} refuses steps of {step_size:g} s and makes its own, of {own:g} s; "
            "its inputs and outputs are held in between"
        )
        return True

    def begin(
        self, experiment: Experiment, alike: tuple[Wires, Results] | None = None
    ) -> tuple[Wires, Results, list[Change]]:
        """Brings the FMUs from reset to the first step; gives what they are bound to, a table with the first row, and
        the parameters that are to be changed.

        Args:
            alike: the same of an experiment with the same scheme, instants and inputs.

        Raises:
            WiringError, SimulationError: as of `run`.
        """
        require(unknown(self.fitted, experiment.inputs, experiment.parameters))
        parameters = self._present(experiment.parameters)
        time = experiment.time() if alike is None else np.asarray(alike[1]["time"])
        due = changes(parameters, time)
        self._step_size.value = experiment.step_size
        if alike is None:
            wires, table = self._known(experiment, time)
        else:
            wires, table = alike[0], alike[0].layout.table_like(alike[1])
        self.reset()
        self._is_new, self.ended = False, None
        self._initialize(wires, table, initial(parameters), experiment.tolerance)
        return wires, table, due

    def _known(self, experiment: Experiment, time: np.ndarray) -> tuple[Wires, Results]:
        """What the FMUs are bound to, and a table with the inputs from outside."""
        samples = self._present(experiment.samples(time))
        wires = self._wired(Scheme(experiment.scheme), tuple(samples))
        return wires, wires.layout.table(time, samples)

    def _tuned(self, steps: Iterable[range], due: Sequence[Change]) -> Iterator[range]:
        """The steps; before some of them parameters are set.

        Raises:
            SimulationError: an FMU refused a value.
        """
        pending = list(due)
        for part in steps:
            first = part.start
            while pending and pending[0].step < part.stop:
                change = pending.pop(0)
                yield range(first, change.step)
                first = change.step
                instance = next(instance for instance in self.instances if instance.name == change.instance)
                instance.set_parameters({change.parameter: change.value})
            yield range(first, part.stop)

    def _present(self, parameters: Mapping[str, Any]) -> dict[str, Any]:
        """What is given without what the FMUs do not have.

        Raises:
            WiringError: that is more than they do without it.
        """
        present = dict(parameters)
        for name in self.fitted.absent.keys() & parameters.keys():
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
        every = self._multiples()
        key = scheme, inputs, *every.items()
        if key not in self._wires:
            fixed = self._step_size, self._make_steps
            self._wires[key] = wired(self.fitted, self.instances, inputs, scheme, *fixed, every)
        return self._wires[key]

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
        """Outputs to inputs until nothing changes; each round settles at least one connection, and after the first one
        only instances whose inputs have changed are called.

        Args:
            anew: whether nothing was sent before.
        """
        data, row, known = table.view(np.uint8).data, wires.row, wires.layout.known
        if anew:
            row[:] = bytes(len(row))
            row[:known] = data[:known]
        before, due = None, {instance.number for instance in self.instances}
        for _ in range(len(self.fitted.system.connections) + 2):
            for call in wires.hand_over:
                if call.changed and call.changed():
                    due.add(call.instance.number)
                if call.instance.number in due:
                    _check(call, status_of(call))
            if row == before:
                data[: table.itemsize] = row[: table.itemsize]
                return
            before, due = row[:], set[int]()
        raise SimulationError("the outputs at the start do not settle: the connections form an algebraic loop")


def _tolerance(instance: Instance, tolerance: float | None) -> float | None:
    """That of a run: the one that is given, else that of the FMU's default experiment."""
    default = instance.interface.description.defaultExperiment
    own = getattr(default, "tolerance", None)  # fmpy says not that there may be none
    return float(own) if tolerance is None and own is not None else tolerance


def _has_ended(refusal: Refusal) -> bool:
    """Whether the FMU has not refused its step but asked for the end of the run."""
    slave = refusal.call.instance.slave
    if refusal.status != fmi2Discard or not refusal.call.function.endswith("DoStep"):
        return False
    return isinstance(slave, FMU2Traced | FMU3Traced) and slave.has_ended()


def _own_step(instance: Instance) -> float:
    """That of an FMU in s, which it says to be fixed or proposes; 0 if it does neither."""
    described = instance.interface.description
    fixed = getattr(described.coSimulation, "fixedInternalStepSize", None)
    default = described.defaultExperiment
    return float(fixed or (default.stepSize if default else None) or 0.0)


def _multiple(own: float, step_size: float) -> int:
    """How many steps of the loop make one; 0 if no whole number does."""
    number = round(own / step_size)
    return number if abs(own - number * step_size) <= 1e-9 * own else 0


def _unfit(refusal: Refusal, step_size: float) -> str:
    """Why an FMU that refuses the first step cannot make its own, if it has one; nothing, or a part of a sentence."""
    instance, own = refusal.call.instance, _own_step(refusal.call.instance)
    if instance.own or refusal.step > 0 or not refusal.call.function.endswith("DoStep") or not own:
        return ""
    return (
        "" if _multiple(own, step_size) else f"; its own step of {own:g} s is no multiple of the loop's {step_size:g} s"
    )


def _check(call: Call, status: int) -> None:
    """Raises the error of a status before the first step."""
    if status not in (fmi2OK, fmi2Warning):
        raise _failure(call, status)


def _failure(call: Call, status: int, time: float | None = None) -> SimulationError:
    """The error of a status at a time in s (of NaN, in the step from it on); None: before the first."""
    if status == NOT_FINITE:
        when = "at the start" if time is None else f"in the step from {time:g} s"
        return call.instance.not_finite(call.names, call.values, when)
    return call.instance.failure(call.function, status, "at the start" if time is None else f"at {time:g} s")
