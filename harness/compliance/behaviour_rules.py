"""Rules for what an FMU does. Each function is given it unpacked, runs it and yields what it does wrong."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from math import inf, isfinite, sin
from typing import Any

from fmpy.model_description import ModelVariable

from ..cosimulation.instance import Instance, Unpacked, instantiated
from ..cosimulation.interface import type_of
from .rule import Rule, Severity

Outputs = list[tuple[str, Any]]

STEPS = 100
"""Communication steps of a run that is compared with another."""

MOST_STEPS = 2000
"""Communication steps of the default experiment that are tried."""

STEP_FACTORS = (1.0, 0.1, 3.7, 1e-3, 10.0, 1.0)
"""Communication steps of different sizes, relative to that of the default experiment."""

READABLE = ("Real", "Integer", "Boolean", "String")


class Host:
    """An instance that is fed with small oscillations around the start values of its Real inputs."""

    def __init__(self, instance: Instance) -> None:
        self.instance = instance
        interface = instance.interface
        default = interface.description.defaultExperiment
        self.step_size = float(default.stepSize or 1e-3) if default else 1e-3
        self.stop = float(default.stopTime or 1.0) if default else 1.0
        self.inputs = [v for v in interface.of_causality("input") if v.type == "Real"]
        self.step, self.time = 0, 0.0

    def start(self) -> None:
        """From instantiation or reset to the first step."""
        self.step, self.time = 0, 0.0
        self.instance.call("setupExperiment", startTime=0.0)
        self.instance.call("enterInitializationMode")
        self._feed()
        self.instance.call("exitInitializationMode")

    def advance(self, size: float) -> Outputs:
        """Makes a communication step; the outputs after it."""
        self._feed()
        self.instance.call("doStep", self.time, size)
        self.step, self.time = self.step + 1, self.time + size
        return self.outputs()

    def run(self, steps: int) -> list[Outputs]:
        """Outputs at the beginning and after each step of the default size."""
        return [self.outputs(), *(self.advance(self.step_size) for _ in range(steps))]

    def outputs(self) -> Outputs:
        return self.read(self.instance.interface.of_causality("output"))

    def read(self, variables: Sequence[ModelVariable]) -> Outputs:
        """Names and values of the variables."""
        values: Outputs = []
        for kind in READABLE:
            alike = [v for v in variables if type_of(v) == kind]
            if alike:
                got = self.instance.call(f"get{kind}", [v.valueReference for v in alike])
                values += [(v.name, value) for v, value in zip(alike, got, strict=True)]
        return values

    def _feed(self) -> None:
        values = []
        for v in self.inputs:
            swing = 0.1 * float(v.nominal or 1.0) * sin(0.1 * self.step)
            values.append(min(max(float(v.start or 0.0) + swing, float(v.min or -inf)), float(v.max or inf)))
        if values:
            self.instance.call("setReal", [v.valueReference for v in self.inputs], values)


@contextmanager
def hosted(fmu: Unpacked, name: str = "checked") -> Iterator[Host]:
    with instantiated(name, fmu) as instance:
        yield Host(instance)
        instance.call("terminate")


def default_experiment(fmu: Unpacked, most_steps: int = MOST_STEPS) -> Iterator[str]:
    """Runs the default experiment; every variable can be read before and after."""
    with hosted(fmu) as host:
        host.start()
        everything = list(fmu.interface.variables.values())
        host.read(everything)
        first = last = host.outputs()
        for _ in range(round(min(host.stop / host.step_size, most_steps))):
            last = host.advance(host.step_size)
        host.read(everything)
    yield from _not_finite(first, "at the start")
    yield from _not_finite(last, "at the end")


def beginning(fmu: Unpacked) -> Iterator[str]:
    """The first steps of the default experiment."""
    return default_experiment(fmu, STEPS)


def any_step_size(fmu: Unpacked) -> Iterator[str]:
    """Small, large and odd steps, if the FMU says that it can handle them."""
    if not _claims(fmu, "canHandleVariableCommunicationStepSize"):
        return
    with hosted(fmu) as host:
        host.start()
        for factor in STEP_FACTORS:
            size = factor * host.step_size
            yield from _not_finite(host.advance(size), f"after a step of {size:g} s")


def repeats_after_reset(fmu: Unpacked) -> Iterator[str]:
    """The same run before and after fmi2Reset."""
    with hosted(fmu) as host:
        host.start()
        first = host.run(STEPS)
        host.instance.call("reset")
        host.start()
        yield from _differences(first, host.run(STEPS), "after reset")


def instances_are_separate(fmu: Unpacked) -> Iterator[str]:
    """One instance alone, and the same beside another one that runs ahead of it."""
    if _claims(fmu, "canBeInstantiatedOnlyOncePerProcess"):
        return
    with hosted(fmu) as host:
        host.start()
        alone = host.run(STEPS)
    with hosted(fmu, "checked") as host, hosted(fmu, "other") as other:
        other.start()
        other.run(STEPS // 2)
        host.start()
        beside = [host.outputs()]
        for _ in range(STEPS):
            other.advance(other.step_size)
            beside.append(host.advance(host.step_size))
        yield from _differences(alone, beside, "beside another instance")


def states_are_restored(fmu: Unpacked) -> Iterator[str]:
    """The run after a restored state is the one before, bit by bit, if the FMU claims so."""
    if not _claims(fmu, "canGetAndSetFMUstate"):
        return
    with hosted(fmu) as host:
        host.start()
        host.run(STEPS)
        position = host.step, host.time
        state = host.instance.call("getFMUstate")
        first = host.run(STEPS)
        host.instance.call("setFMUstate", state)
        host.step, host.time = position
        yield from _differences(first, host.run(STEPS), "after the state was restored")
        if _claims(fmu, "canSerializeFMUstate"):
            saved = host.instance.call("serializeFMUstate", state)
            revived = host.instance.call("deSerializeFMUstate", saved)
            host.instance.call("setFMUstate", revived)
            host.step, host.time = position
            yield from _differences(first, host.run(STEPS), "after the state was written and read")
            host.instance.call("freeFMUstate", revived)
        host.instance.call("freeFMUstate", state)


def _claims(fmu: Unpacked, capability: str) -> bool:
    return bool(getattr(fmu.interface.description.coSimulation, capability))


def _not_finite(outputs: Outputs, when: str) -> Iterator[str]:
    for name, value in outputs:
        if isinstance(value, float) and not isfinite(value):
            yield f"{name} is {value} {when}"


def _differences(expected: list[Outputs], actual: list[Outputs], when: str) -> Iterator[str]:
    """Each output that differs, at the first step at which it does."""
    told: set[str] = set()
    for k, (before, after) in enumerate(zip(expected, actual, strict=True)):
        for (name, one), (_, other) in zip(before, after, strict=True):
            same = one == other or (one != one and other != other)
            if not same and name not in told:
                told.add(name)
                yield f"{name} is {other} {when}, but was {one}, at step {k}"


RUNS = "the default experiment runs, outputs are finite"

BEHAVIOUR_RULES = (
    Rule("runs", Severity.ERROR, RUNS, default_experiment),
    Rule("steps", Severity.ERROR, "steps of any size are accepted, if it claims so", any_step_size),
    Rule("reset", Severity.ERROR, "a second run after reset is the same", repeats_after_reset),
    Rule("instances", Severity.ERROR, "two instances do not see each other", instances_are_separate),
    Rule("states", Severity.ERROR, "saved states are restored, if it claims so", states_are_restored),
)

QUICK_RULES = (Rule("runs", Severity.ERROR, RUNS, beginning),)
