"""What runs an FMU of FMI 3.0 with clocks, in event mode: time-based input clocks tick, triggered ones do not."""

from collections.abc import Iterator
from contextlib import contextmanager
from ctypes import c_double, c_int
from math import inf
from typing import Any

from fmpy.fmi3 import fmi3ValueReference
from fmpy.model_description import ModelDescription, ModelVariable

from fmuloop.errors import SimulationError
from fmuloop.instance import Instance, instantiated
from fmuloop.unpacked_fmu import Unpacked

from .host import Host

PERIODIC = ("constant", "fixed", "tunable")
"""How the intervals of a clock may vary, where the description has them; else the FMU tells them in event mode."""

NOT_YET_KNOWN, CHANGED = 0, 2
"""What the FMU says of an interval (fmi3IntervalQualifier)."""

ANNOUNCED = -1
"""In the place of a clock: the event that the FMU has announced (nextEventTime)."""

MOST_ITERATIONS = 100
"""Of an event, before it counts as one without end."""

NEAR = 1e-9
"""Of the default step: times that are no farther apart are one."""


def has_clocks(description: ModelDescription) -> bool:
    return any(variable.type == "Clock" for variable in description.modelVariables)


def _interval(clock: ModelVariable) -> float | None:
    """That of a periodic clock, if the description has it."""
    if clock.intervalVariability not in PERIODIC:
        return None
    if clock.intervalDecimal is None and clock.intervalCounter and clock.resolution:
        return clock.intervalCounter / clock.resolution
    return None if clock.intervalDecimal is None else float(clock.intervalDecimal)


class EventHost(Host):
    """An instance whose clocks tick. What `due` has is the time of the next tick by the reference of the clock."""

    def __init__(self, instance: Instance) -> None:
        super().__init__(instance)
        clocks = [v for v in instance.interface.variables.values() if v.type == "Clock"]
        self.sent = [v.valueReference for v in clocks if v.causality == "output"]
        timed = [v for v in clocks if v.causality == "input" and v.intervalVariability != "triggered"]
        self.clocks = {v.valueReference: v for v in timed}
        self.intervals = {v.valueReference: _interval(v) for v in timed}
        self.near = NEAR * self.step_size

    def start(self) -> None:
        super().start()
        for reference, clock in self.clocks.items():
            if self.intervals[reference] or clock.intervalVariability in ("changing", "calculated"):
                self.due[reference] = float(clock.shiftDecimal or 0.0)
        self._handle(0.0)

    def _pass(self, size: float) -> None:
        time, end = self.time, self.time + size
        while not self.ended and end - time > self.near:
            until = min(end, max(time, min(self.due.values(), default=inf)))
            answers = self._step(time, until - time) if until - time > self.near else (False,)
            time = until
            if answers and (answers[0] or self._ticking(time)):
                self.instance.call("enterEventMode")
                self._handle(time)

    def _ticking(self, time: float) -> list[int]:
        return [reference for reference, due in self.due.items() if due <= time + self.near]

    def _handle(self, time: float) -> None:
        """From event mode back to step mode."""
        for _ in range(MOST_ITERATIONS):
            ticking = [reference for reference in self._ticking(time) if reference != ANNOUNCED]
            if ticking:
                self.instance.call("setClock", ticking, [True] * len(ticking))
            if self.sent:
                self.instance.call("getClock", self.sent)
            again, self.ended, *_, known, announced = self.instance.call("updateDiscreteStates")
            self.due.pop(ANNOUNCED, None)
            if known:
                self.due[ANNOUNCED] = announced
            self._go_on(time, ticking)
            if self.ended:
                return
            if not again and not self._ticking(time):
                self.instance.call("enterStepMode")
                return
        raise SimulationError(f"fmi3UpdateDiscreteStates wants another iteration after {MOST_ITERATIONS} at {time:g} s")

    def _go_on(self, time: float, ticked: list[int]) -> None:
        """When the clocks tick next."""
        for reference, clock in self.clocks.items():
            counts_down = clock.intervalVariability == "countdown"
            if reference in ticked:
                del self.due[reference]
            interval = self.intervals[reference]
            if interval and reference in ticked:
                shift = float(clock.shiftDecimal or 0.0)
                self.due[reference] = shift + interval * (round((time - shift) / interval) + 1)
            elif not interval and (counts_down or reference in ticked):
                told, qualifier = self._told(reference)
                if qualifier == CHANGED or (qualifier != NOT_YET_KNOWN and not counts_down):
                    self.due[reference] = time + told

    def _told(self, reference: int) -> tuple[float, int]:
        """The interval of a clock and what the FMU says of it."""
        interval, qualifier = (c_double * 1)(), (c_int * 1)()
        self.instance.call("getIntervalDecimal", (fmi3ValueReference * 1)(reference), interval, qualifier)
        return interval[0], qualifier[0]


@contextmanager
def stepped(fmu: Unpacked, name: str = "checked", **options: Any) -> Iterator[Instance]:
    """An instance that is stepped, with event mode if the FMU has clocks: some of them demand it."""
    if has_clocks(fmu.interface.description):
        options["eventModeUsed"] = True
    with instantiated(name, fmu, **options) as instance:
        yield instance


@contextmanager
def hosted(fmu: Unpacked, name: str = "checked", **options: Any) -> Iterator[Host]:
    """In event mode if the FMU has clocks, or the options of fmi3InstantiateCoSimulation say so."""
    events = has_clocks(fmu.interface.description) or options.get("eventModeUsed")
    with stepped(fmu, name, **options) as instance:
        yield EventHost(instance) if events else Host(instance)
        instance.call("terminate")
