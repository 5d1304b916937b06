"""An FMU at one instant, where values are functions of others: what may be set is moved, what follows is read."""

from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from math import inf
from typing import Any, NamedTuple

from fmuloop.errors import SimulationError
from fmuloop.instance import Instance, instantiated
from fmuloop.unpacked_fmu import Unpacked

from .document import REALS, Declared, Document, Unknown, accessor, document
from .event_host import has_clocks, hosted, stepped
from .exchange_host import integrated

MOST_KNOWNS, MOST_UNKNOWNS = 60, 200
"""Of a probe: more would take longer than they tell."""

MOST_REFUSALS = 3
"""After as many values that the FMU does not take, no more are tried."""

STEPS = 3
"""Communication steps before outputs are looked at."""

PART = 0.02
"""Of the default experiment, before derivatives are looked at."""

MOVED = ("Real", "Float32", "Float64", "Integer", "Int32", "Boolean")
"""Types of what is moved and read."""


class Probe(NamedTuple):
    """An instance at an instant.

    Attributes:
        knowns: what may be set then.
        unknowns: what follows, each with the entry of ModelStructure.
        put: sets one of the knowns.
        at_once: whether the unknowns must follow at once. At a communication point FMI forbids to read before the next
            step what was set (2.0: section 4.2.4; 3.0: 4.2.1); FMUs that compute anew all the same can be probed.
    """

    instance: Instance
    knowns: Sequence[Declared]
    unknowns: Sequence[tuple[Declared, Unknown]]
    put: Callable[[Declared, float], None]
    at_once: bool = True

    def read(self) -> list[float]:
        """The values of the unknowns."""
        return values(self.instance, [variable for variable, _ in self.unknowns])

    def at(self, known: Declared, value: float) -> list[float]:
        """The values of the unknowns with that of a known."""
        self.put(known, value)
        return self.read()


def values(instance: Instance, variables: Sequence[Declared]) -> list[Any]:
    """Those of scalars, of any types."""
    value_of: dict[str, Any] = {}
    for kind in dict.fromkeys(accessor(instance.interface.fmi, v.type) for v in variables):
        alike = [v for v in variables if accessor(instance.interface.fmi, v.type) == kind]
        got = instance.call(f"get{kind}", [v.model.valueReference for v in alike])
        value_of.update(zip((v.key for v in alike), got, strict=True))
    return [value_of[v.key] for v in variables]


def put(instance: Instance, variable: Declared, value: Any) -> None:
    """Sets a scalar."""
    instance.call(f"set{accessor(instance.interface.fmi, variable.type)}", [variable.model.valueReference], [value])


def step(variable: Declared, value: float, share: float) -> float:
    """A move away from a value, within bounds: of that share of it or of what is nominal; 1 for whole numbers."""
    if variable.type == "Boolean":
        return 1 - 2 * int(value)
    nominal = abs(float(variable.model.nominal or 1.0)) if variable.type in REALS else 0.0
    size = share * max(abs(value), nominal) if variable.type in REALS else 1
    declared = variable.model.declaredType
    highest = float(variable.model.max or (declared.max if declared else None) or inf)
    return size if value + 2 * size <= highest else -size


def _scalars(doc: Document, keys: Sequence[str]) -> list[Declared]:
    chosen = [doc.variables[key] for key in keys]
    return [v for v in chosen if v.type in MOVED and v.is_scalar and "clocks" not in v.attributes]


def _listed(doc: Document, sections: Sequence[str]) -> list[tuple[Declared, Unknown]]:
    """The unknowns of these sections; those that are a state say nothing of what follows from states."""
    unknowns = {u.key: u for section in sections for u in doc.unknowns(section)}
    states = set(doc.states.values())
    return [(v, unknowns[v.key]) for v in _scalars(doc, list(unknowns)) if v.key not in states][:MOST_UNKNOWNS]


def _inputs(doc: Document, rates: Collection[int]) -> list[Declared]:
    """Without those that are rates of change of others."""
    inputs = [key for key, v in doc.variables.items() if v.model.causality == "input"]
    return [v for v in _scalars(doc, inputs) if v.model.valueReference not in rates]


@contextmanager
def _exchanging(fmu: Unpacked) -> Iterator[Probe]:
    """In continuous-time mode: derivatives and outputs of states and inputs."""
    doc = document(fmu.interface)
    states = _scalars(doc, list(doc.states.values()))
    if len(states) < len(doc.states):
        states = []
    with integrated(fmu) as host:
        host.start()
        host.advance(host.first + PART * host.duration)
        x = host.states()

        def move(known: Declared, value: float) -> None:
            if known in states:
                x[states.index(known)] = value
                host.set_states(x)
            else:
                put(host.instance, known, value)

        inputs = [
            v
            for v in _inputs(doc, fmu.interface.rates.values())
            if v.type in REALS and v.model.variability == "continuous"
        ]
        knowns = [] if host.ended else [*states, *inputs]
        yield Probe(host.instance, knowns, _listed(doc, ["Derivatives", "Outputs"]), move)


@contextmanager
def _stepping(fmu: Unpacked) -> Iterator[Probe]:
    """At a communication point: outputs of inputs."""
    doc = document(fmu.interface)
    with hosted(fmu) as host:
        host.start()
        host.run(STEPS)
        knowns = [] if host.ended else _inputs(doc, fmu.interface.rates.values())
        unknowns = _listed(doc, ["Outputs"])
        yield Probe(host.instance, knowns, unknowns, lambda known, v: put(host.instance, known, v), at_once=False)


@contextmanager
def initializing(fmu: Unpacked) -> Iterator[Probe]:
    """In initialization mode: initial unknowns of what has a start value."""
    doc = document(fmu.interface)
    exact = [
        key for key, v in doc.variables.items() if v.model.initial == "exact" and v.model.variability != "constant"
    ]
    with initialized(fmu) as instance:
        knowns = [v for v in _scalars(doc, exact) if v.model.causality != "structuralParameter"]
        yield Probe(instance, knowns, _listed(doc, ["InitialUnknowns"]), lambda known, v: put(instance, known, v))


@contextmanager
def elsewhere(fmu: Unpacked) -> Iterator[Probe]:
    """The same with all that has a start value away from it: where a state is 0, its factors change nothing."""
    with initializing(fmu) as probe:
        for k, known in enumerate(probe.knowns):
            (value,) = values(probe.instance, [known])
            probe.put(known, value + step(known, value, 0.02 / (k + 1.0)))
        yield probe


@contextmanager
def initialized(fmu: Unpacked) -> Iterator[Instance]:
    """An instance of the FMU in initialization mode."""
    default = fmu.interface.description.defaultExperiment
    exchanges = fmu.interface.description.coSimulation is None
    with instantiated("checked", fmu, exchanging=True) if exchanges else stepped(fmu) as instance:
        instance.call("start", float(default.startTime or 0.0) if default else 0.0, None)
        yield instance


Mode = Callable[[Unpacked], AbstractContextManager[Probe]]


def modes(fmu: Unpacked) -> list[Mode]:
    """Those after initialization that the FMU has."""
    doc = fmu.interface.description
    kind = doc.coSimulation
    stepped = kind and (kind.hasEventMode or not has_clocks(doc))
    return [*([_exchanging] if doc.modelExchange else []), *([_stepping] if stepped else [])]


def each_known(fmu: Unpacked, mode: Mode, use: Callable[[Probe, Declared], Iterator[str]]) -> Iterator[str]:
    """What a function finds for each known; what the FMU does not take is left out, and it starts anew."""
    tried = refusals = 0
    while refusals < MOST_REFUSALS:
        try:
            with mode(fmu) as probe:
                for known in probe.knowns[tried:MOST_KNOWNS]:
                    tried += 1
                    yield from use(probe, known)
            return
        except SimulationError:
            refusals += 1
