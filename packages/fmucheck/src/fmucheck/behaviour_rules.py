"""Rules for what an FMU does. Each function is given it unpacked, runs it and yields what it does wrong."""

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from functools import partial
from math import isfinite

from fmpy.fmi2 import fmi2Discard

from fmuloop import instance
from fmuloop.errors import SimulationError
from fmuloop.unpacked_fmu import Unpacked

from .document import document
from .event_host import hosted
from .host import Host, Outputs
from .rule import Clause, Rules, Severity

STEPS = 100
"""Communication steps of a run that is compared with another."""

MOST_STEPS = 2000
"""Communication steps of the default experiment that are tried."""

STEP_FACTORS = (1.0, 0.1, 3.7, 1e-3, 10.0, 1.0)
"""Communication steps of different sizes, relative to that of the default experiment."""


def _claims(fmu: Unpacked, capability: str) -> bool:
    return document(fmu.interface).claims(capability, "CoSimulation")


def _not_finite(outputs: Outputs, when: str) -> Iterator[str]:
    for name, value in outputs:
        if isinstance(value, float) and not isfinite(value):
            yield f"{name} is {value} {when}"


def _differences(expected: list[Outputs], actual: list[Outputs], when: str, tolerance: float = 0.0) -> Iterator[str]:
    """Each output that differs by more than the relative tolerance, at the first step at which it does."""
    reported: set[str] = set()
    for k, (before, after) in enumerate(zip(expected, actual, strict=True)):
        for (name, value), (_, later) in zip(before, after, strict=True):
            same = value == later or (value != value and later != later)
            if not same and tolerance and isinstance(value, float):
                same = abs(value - later) <= tolerance * max(abs(value), abs(later), 1.0)
            if not same and name not in reported:
                reported.add(name)
                yield f"{name} is {later} {when}, but was {value}, at step {k}"


BEHAVIOUR_RULES = Rules()


@BEHAVIOUR_RULES.rule(
    "runs",
    Severity.ERROR,
    "the default experiment runs, outputs are finite",
    Clause("4.2.2", "4.2.1"),
    others="FMUChecker",
)
def default_experiment(fmu: Unpacked, most_steps: int = MOST_STEPS) -> Iterator[str]:
    """Runs the default experiment; every variable can be read before and after."""
    with hosted(fmu) as host:
        host.start()
        everything = list(fmu.interface.variables.values())
        host.read(everything)
        first = last = host.outputs()
        for _ in range(_steps(host, most_steps)):
            last = host.advance(host.step_size)
        host.read(everything)
    yield from _not_finite(first, "at the start")
    yield from _not_finite(last, "at the end")


def _steps(host: Host, most: int = MOST_STEPS) -> int:
    """Of the default experiment, as far as it is run."""
    return round(min(host.stop / host.step_size, most))


@BEHAVIOUR_RULES.rule(
    "end", Severity.NOTE, f"it does not end the default experiment (first {MOST_STEPS} steps)", Clause("4.2.1", "4.2.1")
)
def does_not_end(fmu: Unpacked) -> Iterator[str]:
    """FMI lets an FMU ask for the end, and a host has no more than what was until then."""
    with suppress(SimulationError), hosted(fmu) as host:  # which the rule `runs` tells
        host.start()
        for _ in range(_steps(host)):
            begins = host.time
            host.advance(host.step_size)
            if host.ended:
                yield f"it ends the default experiment at {begins:g} of {host.stop:g} s"
                return


@BEHAVIOUR_RULES.rule(
    "steps", Severity.ERROR, "steps of any size are accepted, if it claims so", Clause("4.3.1", "4.4")
)
def any_step_size(fmu: Unpacked) -> Iterator[str]:
    """Small, large and odd steps, if the FMU says that it can handle them."""
    if not _claims(fmu, "canHandleVariableCommunicationStepSize"):
        return
    with hosted(fmu) as host:
        host.start()
        for factor in STEP_FACTORS:
            size = factor * host.step_size
            try:
                outputs = host.advance(size)
            except SimulationError:
                if host.instance.status != fmi2Discard:
                    raise
                return  # FMI lets it discard a step that is too long for it
            yield from _not_finite(outputs, f"after a step of {size:g} s")


@BEHAVIOUR_RULES.rule("reset", Severity.ERROR, "a second run after reset is the same", Clause("2.1.6", "2.3.1"))
def repeats_after_reset(fmu: Unpacked) -> Iterator[str]:
    """The same run before and after fmi2Reset."""
    with hosted(fmu) as host:
        host.start()
        first = host.run(STEPS)
        host.instance.call("reset")
        host.start()
        yield from _differences(first, host.run(STEPS), "after reset")


@BEHAVIOUR_RULES.rule("instances", Severity.ERROR, "two instances do not see each other", Clause("2.1.5", "2.4.2"))
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


Restored = Iterator[tuple[list[Outputs], list[Outputs], str]]
"""A run from a saved state, the one after that was restored, and how."""


def _restored(fmu: Unpacked) -> Restored:
    if not _claims(fmu, "canGetAndSetFMUState"):
        return
    with hosted(fmu) as host:
        host.start()
        steps = round(max(1.0, min(host.stop / host.step_size / 3.0, STEPS)))  # before the FMU may have ended
        host.run(steps)
        position = host.position()
        state = host.instance.call("getFMUstate")
        first = host.run(steps)
        host.instance.call("setFMUstate", state)
        host.go_to(position)
        yield first, host.run(steps), "after the state was restored"
        if _claims(fmu, "canSerializeFMUState"):
            saved = host.instance.call("serializeFMUstate", state)
            revived = host.instance.call("deSerializeFMUstate", saved)
            host.instance.call("setFMUstate", revived)
            host.go_to(position)
            yield first, host.run(steps), "after the state was written and read"
            host.instance.call("freeFMUstate", revived)
        host.instance.call("freeFMUstate", state)


def _tolerance(fmu: Unpacked) -> float:
    default = fmu.interface.description.defaultExperiment
    return float(default.tolerance) if default and default.tolerance is not None else 0.0


@BEHAVIOUR_RULES.rule(
    "states", Severity.ERROR, "saved states are restored, if it claims so", Clause("2.1.8", "2.2.7.4")
)
def states_are_restored(fmu: Unpacked) -> Iterator[str]:
    """The run after a restored state is the one before, within the tolerance of the default experiment."""
    for first, again, when in _restored(fmu):
        yield from _differences(first, again, when, _tolerance(fmu))


@BEHAVIOUR_RULES.rule(
    "states-exact",
    Severity.WARNING,
    "saved states are restored bit by bit, if it claims so",
    Clause("2.1.8", "2.2.7.4"),
)
def states_are_exact(fmu: Unpacked) -> Iterator[str]:
    """Differences within that tolerance, and how large they are."""
    if not _tolerance(fmu):
        return
    with suppress(SimulationError):  # which the rule `states` tells
        yield from _near(fmu)


def _near(fmu: Unpacked) -> Iterator[str]:
    for first, again, when in _restored(fmu):
        far = {text.split(" is ")[0] for text in _differences(first, again, when, _tolerance(fmu))}
        near = (text for text in _differences(first, again, when) if text.split(" is ")[0] not in far)
        yield from (f"{text}; the tolerance of the default experiment is {_tolerance(fmu):g}" for text in near)


@BEHAVIOUR_RULES.rule("memory", Severity.ERROR, "memory of the host is given back", Clause("2.1.5"))
def memory_is_given_back(fmu: Unpacked) -> Iterator[str]:
    """What was allocated for an instance of FMI 2.0 when that has been freed; FMI 3.0 has no such function."""
    before = set(instance.blocks)
    with hosted(fmu) as host:
        host.start()
        host.run(STEPS)
    if kept := instance.blocks - before:
        yield f"{len(kept)} blocks of memory are not given back by fmi2FreeInstance"


@BEHAVIOUR_RULES.rule(
    "tunable", Severity.ERROR, "tunable parameters can be set between steps", Clause("2.2.7, 4.2.4", "2.4.7.4")
)
def tunable_parameters(fmu: Unpacked) -> Iterator[str]:
    """Each parameter that the FMU calls tunable is set to the value that it has; the run goes on."""
    parameters = fmu.interface.of_causality("parameter")
    tunable = [v for v in parameters if v.variability == "tunable" and fmu.interface.access(v)]
    if not tunable:
        return
    with hosted(fmu) as host:
        host.start()
        host.run(STEPS // 2)
        present = [host.instance.get([v]) for v in tunable]  # once one is set, FMI forbids it up to the next step
        for variable, value in zip(tunable, present, strict=True) if not host.ended else ():
            try:
                host.instance.set([variable], value)
            except SimulationError as refusal:
                yield f"{variable.name} is called tunable, and is not: {refusal}"
                return
        yield from _not_finite(host.advance(host.step_size), "after tunable parameters were set")


QUICK_RULES = [
    replace(rule, problems=partial(default_experiment, most_steps=STEPS))
    for rule in BEHAVIOUR_RULES
    if rule.problems is default_experiment
]
"""The first steps of the default experiment."""
