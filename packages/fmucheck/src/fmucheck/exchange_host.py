"""What integrates an FMU for the rules of model exchange: CVode, as fmpy has it."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from ctypes import c_double
from math import inf, sin
from typing import Any, cast

from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import fmi2Discard
from fmpy.sundials import CVodeSolver

from fmuloop.errors import SimulationError
from fmuloop.instance import FMU2Exchanging, FMU3Exchanging, Instance, instantiated
from fmuloop.unpacked_fmu import Unpacked
from toolground.plain_text import plain

from .host import near_start

TOLERANCE = 1e-6

SHORTEST = 1e-12
"""Way to an event, over the time, that is not integrated."""

UPDATES = {2: "fmi2NewDiscreteStates", 3: "fmi3UpdateDiscreteStates"}
"""By FMI, what iterates at an event."""

MOST_ITERATIONS = 100
"""Of an event, before it counts as one without end."""

MOST_EVENTS = 1000
"""Of a run; at the next one it ends."""


class _Solver(CVodeSolver):
    """CVode for an FMU that may refuse a call: one that it discards is tried again with a shorter step."""

    refusal: FMICallException | None = None

    def f(self, *arguments: Any) -> int:
        return self._answer(super().f, *arguments)

    def g(self, *arguments: Any) -> int:
        return self._answer(super().g, *arguments)

    def _answer(self, function: Callable[..., int], *arguments: Any) -> int:
        try:
            return function(*arguments)
        except FMICallException as error:
            self.refusal = error
            return 1 if error.status == fmi2Discard else -1


class ExchangeHost:
    """An instance that is integrated, its Real inputs moved a little about their start values.

    Attributes:
        ended: whether the FMU has asked for the end of the simulation, or has had MOST_EVENTS.
    """

    def __init__(self, instance: Instance) -> None:
        self.instance = instance
        description = instance.interface.description
        default = description.defaultExperiment
        self.duration = float(default.stopTime or 1.0) - float(default.startTime or 0.0) if default else 1.0
        self.first = float(default.startTime or 0.0) if default else 0.0
        self.sizes = description.numberOfContinuousStates, description.numberOfEventIndicators
        """Numbers of continuous states and of event indicators."""
        inputs = instance.interface.of_causality("input")
        self._inputs = [v for v in inputs if v.type == "Real" and v.variability in (None, "continuous")]
        self.time, self.events, self.ended, self._next = 0.0, 0, False, inf
        self._solver: _Solver | None = None

    def start(self) -> None:
        """From instantiation or reset to continuous-time mode."""
        self.time, self.events, self.ended = self.first, 0, False
        self.instance.call("start", self.first, None)
        self.apply(self.first)
        self.instance.call("exitInitializationMode")
        if self.instance.interface.fmi == 3:  # where arrays have sizes that parameters may change
            self.sizes = self.instance.call("sizes")
        self._iterate()

    def apply(self, time: float) -> None:
        """Sets the inputs of an instant; what the solver calls them by."""
        swing = sin(6.0 * (time - self.first) / (self.duration or 1.0))
        if self._inputs:
            references = [v.valueReference for v in self._inputs]
            cast(Any, self.instance.slave).setFloat64(references, [near_start(v, swing) for v in self._inputs])

    def _iterate(self) -> None:
        for _ in range(MOST_ITERATIONS):
            again, ends, *_, known, time = self.instance.call("newDiscreteStates")
            self._next, self.ended = time if known else inf, self.ended or ends
            if not again or ends:
                break
        else:
            raise SimulationError(
                f"{UPDATES[self.instance.interface.fmi]} wants another iteration after {MOST_ITERATIONS} "
                f"at {self.time:g} s"
            )
        if not self.ended:
            self.instance.call("enterContinuousTimeMode")

    def states(self) -> list[float]:
        return self._numbers("getContinuousStates", self.sizes[0])

    def set_states(self, values: Sequence[float]) -> None:
        self.instance.call("setContinuousStates", (c_double * self.sizes[0])(*values), self.sizes[0])

    def rates(self) -> list[float]:
        return self._numbers("getDerivatives", self.sizes[0])

    def nominals(self) -> list[float]:
        return self._numbers("getNominalsOfContinuousStates", self.sizes[0])

    def indicators(self) -> list[float]:
        return self._numbers("getEventIndicators", self.sizes[1])

    def _numbers(self, function: str, size: int) -> list[float]:
        room = (c_double * size)()
        if size:  # else there is nothing to ask for
            self.instance.call(function, room, size)
        return list(room)

    def advance(self, end: float) -> None:
        """Integrates up to a time, through all events on the way.

        Raises:
            SimulationError: the FMU refused a call, or the solver cannot go on.
        """
        while not self.ended and self.time < end:
            solver = self._solver or self._made()
            self._solver = solver
            until = max(self.time, min(end, self._next))
            met = self._step(solver, until)
            self.instance.call("setTime", self.time)
            self.apply(self.time)
            entering, self.ended = self.instance.call("completedIntegratorStep")
            if self.ended:
                return
            if met or entering or self.time >= self._next:
                self.events += 1
                self.instance.call("enterEventMode")
                self._iterate()
                self.ended = self.ended or self.events >= MOST_EVENTS
                solver.reset(self.time)

    def _step(self, solver: _Solver, until: float) -> bool:
        """Integrates to a time, or to an event before it; whether it met one."""
        if until - self.time <= SHORTEST * (1.0 + abs(until)):
            self.time = until
            return False
        try:
            met, _, self.time = solver.step(self.time, until)
        except RuntimeError as error:
            refusal = solver.refusal
            if refusal is not None:
                raise self.instance.failure(refusal.function, refusal.status) from error
            raise SimulationError(f"CVode cannot integrate it beyond {self.time:g} s: {plain(error)}") from error
        return met

    def _made(self) -> _Solver:
        slave = cast(FMU2Exchanging | FMU3Exchanging, self.instance.slave)
        return _Solver(
            nx=self.sizes[0],
            nz=self.sizes[1],
            get_x=slave.getContinuousStates,
            set_x=slave.setContinuousStates,
            get_dx=slave.getDerivatives,
            get_z=slave.getEventIndicators,
            get_nominals=self._scales,
            set_time=slave.setTime,
            input=self,
            startTime=self.time,
            maxStep=(self.duration or 1.0) / 50.0,
            relativeTolerance=TOLERANCE,
            maxNumSteps=100_000,
        )

    def _scales(self, room: Any, _size: int) -> None:
        """What the solver divides by: 1 for a nominal value that is none, which a rule of its own finds."""
        for k, nominal in enumerate(self.nominals()):
            room[k] = nominal if 0.0 < nominal < inf else 1.0

    def begin_anew(self) -> None:
        """After a reset or another state: the solver knows nothing any more."""
        self._solver = None


@contextmanager
def integrated(fmu: Unpacked) -> Iterator[ExchangeHost]:
    with instantiated("checked", fmu, exchanging=True) as instance:
        yield ExchangeHost(instance)
        instance.call("terminate")
