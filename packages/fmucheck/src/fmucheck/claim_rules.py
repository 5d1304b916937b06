"""Rules for what an FMU claims in its description and its binary may not keep. Each function is given it unpacked."""

from collections.abc import Iterator
from copy import copy
from ctypes import c_double
from functools import partial
from math import isclose
from typing import Any

from fmuloop.errors import InstantiationError, SimulationError
from fmuloop.instance import instantiated
from fmuloop.unpacked_fmu import Unpacked

from .document import DOUBLES, REALS, TRUE, Declared, document
from .event_host import hosted
from .exchange_host import ExchangeHost, integrated
from .probe import Probe, each_known, elsewhere, initialized, initializing, modes, step, values
from .rule import Clause, Rules, Severity

FAR, NEAR = 1e-2, 1e-5
"""Shares by which a value is moved: so that something is seen to follow, and for a difference quotient."""

SMOOTH, AGREES = 1e-3, 1e-2
"""Two difference quotients of a smooth function differ by no more, relatively, and so does a derivative from them."""

NOISE = 1e-9
"""Relative error of the values that are subtracted."""

STEPS = 100
"""Communication steps in which an FMU shows that it keeps a claim."""

MOST_INDICATORS = 8
"""More event indicators than it has said are looked for."""

UNTOUCHED = 1.2345e300
"""Stands where the FMU must not write."""


CLAIM_RULES = Rules()
"""Of FMUs of any kind."""


@CLAIM_RULES.rule(
    "version", Severity.ERROR, "the binary is of the version of the description", Clause("2.1.4", "2.2.4")
)
def version(fmu: Unpacked) -> Iterator[str]:
    """Version, and in FMI 2.0 the platform of types."""
    fmi, expected = fmu.interface.fmi, str(fmu.interface.description.fmiVersion)
    with initialized(fmu) as instance:
        answer = instance.call("getVersion")
        if answer.split(".")[:2] != expected.split(".")[:2]:
            yield f"fmi{fmi}GetVersion answers {answer!r}, and the description is of {expected}"
        if fmi == 2 and (platform := instance.call("getTypesPlatform")) != "default":
            yield f'fmi2GetTypesPlatform answers {platform!r}; it must be "default"'


@CLAIM_RULES.rule(
    "functions",
    Severity.ERROR,
    "the binary has all functions of the standard",
    Clause("2.1.3", "2.2.1"),
    "FMUChecker",
)
def functions(fmu: Unpacked) -> Iterator[str]:
    """Those that it lacks; hosts that bind all at once cannot load it."""
    with initialized(fmu) as instance:
        if instance.slave.missing:
            yield f"it has no {', '.join(instance.slave.missing)}"


@CLAIM_RULES.rule(
    "token", Severity.WARNING, "it is instantiated with the token of its description alone", Clause("2.1.5", "2.3.1")
)
def token(fmu: Unpacked) -> Iterator[str]:
    """Whether another guid or instantiationToken is refused."""
    other, model = copy(fmu.interface), copy(fmu.interface.description)
    model.guid, other.description = "{another}", model
    try:
        with initialized(fmu._replace(interface=other)):
            yield f"it takes any {'guid' if fmu.interface.fmi == 2 else 'instantiationToken'}"
    except (InstantiationError, SimulationError):
        return


@CLAIM_RULES.rule(
    "starts", Severity.ERROR, "the binary starts with the values of the description", Clause("2.2.7", "2.4.7.4")
)
def starts(fmu: Unpacked) -> Iterator[str]:
    """Values in initialization mode that are not those of the description. A local discrete variable may have another
    one: events of the initialization can change it."""
    doc = document(fmu.interface)
    exact = [v for v in doc.variables.values() if v.model.initial == "exact" and doc.starts(v)]
    exact = [v for v in exact if v.type not in ("Clock", "Binary")]
    exact = [v for v in exact if (v.model.causality, v.model.variability) != ("local", "discrete")]
    scalars = [v for v in exact if v.is_scalar]
    with initialized(fmu) as instance:
        actual = {v.key: [value] for v, value in zip(scalars, values(instance, scalars), strict=True)}
        for variable in exact:
            if variable.key not in actual:
                actual[variable.key] = _elements(instance, variable, doc.size(variable))
            for start, value in zip(doc.starts(variable), actual[variable.key], strict=True):
                if not _starts_at(variable, start, value):
                    yield f"{variable.name} starts at {_text(value)}, in the description at {start}"
                    break


def _text(value: Any) -> Any:
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else value


def _starts_at(variable: Declared, start: str, value: Any) -> bool:
    if variable.type == "String":
        return _text(value) == start
    if variable.type == "Boolean":
        return bool(value) == (start in TRUE)
    if variable.type in REALS:
        return isclose(float(start), value, rel_tol=1e-6 if variable.type == "Float32" else 1e-9)
    return int(start) == value


@CLAIM_RULES.rule("sets", Severity.ERROR, "what is set in initialization mode can be read", Clause("2.1.7", "2.2.6.2"))
def sets(fmu: Unpacked) -> Iterator[str]:
    """Parameters and inputs that keep the value that they had, without a refusal."""
    yield from each_known(fmu, initializing, _not_set)


def _not_set(probe: Probe, known: Declared) -> Iterator[str]:
    if known.model.causality not in ("parameter", "input"):
        return
    (before,) = values(probe.instance, [known])
    moved = before + step(known, before, FAR)
    probe.put(known, moved)
    (after,) = values(probe.instance, [known])
    if after == before:
        yield f"{known.name} is {_text(after)} after it was set to {moved}"
    probe.put(known, before)


@CLAIM_RULES.rule(
    "independent", Severity.ERROR, "nothing follows from what it is said not to depend on", Clause("2.2.8", "2.4.8")
)
def independent(fmu: Unpacked) -> Iterator[str]:
    """Each known is moved, in initialization mode, at a communication point and in continuous-time mode."""
    problems: set[str] = set()
    for mode in (initializing, elsewhere, *modes(fmu)):
        problems.update(each_known(fmu, mode, _depends))
    yield from sorted(problems)


def _depends(probe: Probe, known: Declared) -> Iterator[str]:
    (value,) = values(probe.instance, [known])
    size = step(known, value, FAR)
    before, after, further = probe.read(), probe.at(known, value + size), None
    if known.type in REALS:
        further = probe.at(known, value + 2 * size)
    if probe.at(known, value) != before:
        return  # what was read is not a function of what was set
    for k, (variable, unknown) in enumerate(probe.unknowns):
        on = unknown.dependencies
        if on is None or variable.key == known.key:
            continue
        if known.key not in on:
            if after[k] != before[k]:
                yield f"{variable.name} depends on {known.name}, and does not say so"
        elif further and variable.type in REALS and unknown.kinds and unknown.kinds[on.index(known.key)] == "constant":
            near, far = after[k] - before[k], further[k] - after[k]
            if abs(near - far) > SMOOTH * max(abs(near), abs(far)) + NOISE * abs(before[k]):
                yield f"{variable.name} does not follow from {known.name} by a constant factor, as it says"


@CLAIM_RULES.rule(
    "directional-derivatives",
    Severity.ERROR,
    "directional derivatives are those of its values, if it claims to have them",
    Clause("2.1.9", "2.2.11"),
)
def directional_derivatives(fmu: Unpacked) -> Iterator[str]:
    """Against differences, in continuous-time mode and at a communication point."""
    if document(fmu.interface).claims("providesDirectionalDerivatives"):
        yield from _derivatives(fmu, "Directional")


@CLAIM_RULES.rule(
    "adjoint-derivatives",
    Severity.ERROR,
    "adjoint derivatives are those of its values, if it claims to have them",
    Clause(fmi3="2.2.11"),
)
def adjoint_derivatives(fmu: Unpacked) -> Iterator[str]:
    """As the directional ones."""
    if document(fmu.interface).claims("providesAdjointDerivatives"):
        yield from _derivatives(fmu, "Adjoint")


def _derivatives(fmu: Unpacked, kind: str) -> Iterator[str]:
    for mode in modes(fmu):
        yield from dict.fromkeys(each_known(fmu, mode, partial(_compared, kind=kind)))


def _compared(probe: Probe, known: Declared, kind: str) -> Iterator[str]:
    reals = [k for k, (variable, _) in enumerate(probe.unknowns) if variable.type in DOUBLES]
    if known.type not in DOUBLES or not reals:
        return
    (value,) = values(probe.instance, [known])
    size = step(known, value, NEAR)
    before = probe.read()
    halves = [_slopes(probe, known, value, part * size) for part in (1.0, 0.5)]
    if not (probe.at_once or any(map(any, halves))):
        return
    references = [probe.unknowns[k][0].model.valueReference for k in reals]
    of = known.model.valueReference
    try:
        if kind == "Directional":
            derivatives = [0.5 * d for d in probe.instance.call("getDirectionalDerivative", references, [of], [2.0])]
        else:
            derivatives = [0.5 * probe.instance.call("getAdjointDerivative", [r], [of], [2.0])[0] for r in references]
    except SimulationError as error:
        yield str(error)
        return
    for k, derivative in zip(reals, derivatives, strict=True):
        whole, half, name = halves[0][k], halves[1][k], probe.unknowns[k][0].name
        noise = NOISE * abs(before[k] or 1.0) / abs(size)
        if abs(whole - half) > SMOOTH * max(abs(whole), abs(half)) + noise:
            continue  # an edge
        if abs(derivative - half) > AGREES * max(abs(derivative), abs(half)) + noise:
            yield f"the {kind.lower()} derivative of {name} by {known.name} is {derivative:g}, by differences {half:g}"
    if probe.read() != before:
        yield f"asking for a {kind.lower()} derivative changes values"


def _slopes(probe: Probe, known: Declared, value: float, size: float) -> list[float]:
    above, below = probe.at(known, value + size), probe.at(known, value - size)
    probe.put(known, value)
    return [(high - low) / (2 * size) for high, low in zip(above, below, strict=True)]


STEPPING_CLAIM_RULES = Rules()
"""Of FMUs that are stepped."""


@STEPPING_CLAIM_RULES.rule(
    "output-derivatives",
    Severity.ERROR,
    "output derivatives are those of its outputs, if it claims to have them",
    Clause("4.2.3", "4.2.1"),
)
def output_derivatives(fmu: Unpacked) -> Iterator[str]:
    """Against the slopes of the outputs, at steps where these are smooth; most must agree."""
    kind = fmu.interface.description.coSimulation
    doc = document(fmu.interface)
    outputs = [v for v in doc.variables.values() if v.model.causality == "output" and v.type in DOUBLES]
    outputs = [v for v in outputs if v.model.variability in (None, "continuous") and v.is_scalar]
    if not kind or not kind.maxOutputDerivativeOrder or not outputs:
        return
    references = [v.model.valueReference for v in outputs]
    function = "getRealOutputDerivatives" if fmu.interface.fmi == 2 else "getOutputDerivatives"
    rows: list[list[float]] = []
    rates: list[list[float]] = []
    with hosted(fmu) as host:
        host.inputs = []  # they stay as they are, so that outputs are smooth
        host.start()
        for _ in range(STEPS):
            host.advance(host.step_size)
            if host.ended:
                break
            rows.append(values(host.instance, outputs))
            rates.append(host.instance.call(function, references, [1] * len(references)))
        size = host.step_size
    for k, variable in enumerate(outputs):
        smooth, wrong, example = 0, 0, ""
        for before, now, after, rate in zip(rows, rows[1:], rows[2:], rates[1:], strict=False):
            rise, next_rise = (now[k] - before[k]) / size, (after[k] - now[k]) / size
            largest = max(abs(rise), abs(next_rise))
            if abs(rise - next_rise) > 0.1 * largest:
                continue
            smooth += 1
            if abs(rate[k] - 0.5 * (rise + next_rise)) > 0.3 * largest + NOISE * abs(now[k]) / size:
                wrong += 1
                example = example or f"{rate[k]:g}, its slope {0.5 * (rise + next_rise):g}"
        if wrong > 0.5 * smooth:
            yield f"the output derivative of {variable.name} is {example}"


@STEPPING_CLAIM_RULES.rule(
    "intermediate-update",
    Severity.ERROR,
    "intermediate updates come within the step, if it claims to have them",
    Clause(fmi3="4.2.2"),
)
def intermediate_update(fmu: Unpacked) -> Iterator[str]:
    """Of FMI 3.0: the callback is called if there is a variable to exchange, at times of the step."""
    doc = document(fmu.interface)
    if not doc.claims("providesIntermediateUpdate"):
        return
    exchanged = [
        v.model.valueReference for v in doc.variables.values() if v.attributes.get("intermediateUpdate") in TRUE
    ]
    times: list[float] = []

    def update(_environment: Any, time: float, *_: Any) -> None:
        times.append(time)

    with hosted(fmu, intermediateUpdate=update, requiredIntermediateVariables=exchanged) as host:
        host.start()
        called = 0
        for _ in range(STEPS):
            begin = host.time
            host.advance(host.step_size)
            called += len(times)
            margin = 0.5 * host.step_size
            outside = [time for time in times if not begin - margin <= time <= host.time + margin]
            times.clear()
            if outside:
                yield f"an intermediate update is of {outside[0]:g} s, in the step from {begin:g} to {host.time:g} s"
                break
            if host.ended:
                break
        if exchanged and not called:
            yield f"it has called no intermediate update in {STEPS} steps"


@STEPPING_CLAIM_RULES.rule(
    "event-mode", Severity.ERROR, "event mode can be entered and left, if it claims to have it", Clause(fmi3="4.2.1")
)
def event_mode(fmu: Unpacked) -> Iterator[str]:
    """Of FMI 3.0: a run with event mode."""
    if document(fmu.interface).claims("hasEventMode"):
        with hosted(fmu, eventModeUsed=True) as host:
            host.start()
            host.run(STEPS)
    yield from ()


EXCHANGE_CLAIM_RULES = Rules()
"""Of FMUs for model exchange."""


@EXCHANGE_CLAIM_RULES.rule(
    "exchange-order",
    Severity.ERROR,
    "states and derivatives are those of ModelStructure, in its order",
    Clause("2.2.8, 3.2.2", "2.4.8, 3.2.1"),
)
def order(fmu: Unpacked) -> Iterator[str]:
    """States are set to values of their own; they and their derivatives are read by value reference too."""
    doc = document(fmu.interface)
    with integrated(fmu) as host:
        host.start()
        if host.ended or not host.sizes[0]:
            return
        moved = [x + 0.01 * (k + 1) * max(abs(x), 1.0) for k, x in enumerate(host.states())]
        host.set_states(moved)
        if host.states() != moved:
            yield "states are not those that were set"
            return
        for what, keys, there in (
            ("state", doc.states.values(), moved),
            ("derivative", doc.states.keys(), host.rates()),
        ):
            variables = [doc.variables[key] for key in keys]
            read = [value for v in variables for value in _elements(host.instance, v, doc.size(v))]
            names = [v.name for v in variables for _ in range(doc.size(v))]
            if len(read) != len(there):
                yield f"it has {len(there)} {what}s, and ModelStructure lists {len(read)}"
                return
            for name, listed, value in zip(names, read, there, strict=True):
                if not isclose(listed, value, rel_tol=1e-9, abs_tol=1e-300):
                    yield f"{what} {name} is {listed:g}, but {value:g} in its place among the {what}s"
                    break


def _elements(instance: Any, variable: Declared, size: int) -> list[Any]:
    """The values of a variable, which may be an array."""
    of_size = () if variable.type == "Real" else (size,)
    return instance.call(f"get{variable.type}", [variable.model.valueReference], *of_size)


@EXCHANGE_CLAIM_RULES.rule(
    "exchange-indicators",
    Severity.ERROR,
    "there are as many event indicators as the description says",
    Clause("2.2.1, 3.2.2", "2.4.8, 3.2.1"),
)
def indicators(fmu: Unpacked) -> Iterator[str]:
    """Their number; in FMI 2.0 no function tells it, so another one is tried where that is refused."""
    doc = document(fmu.interface)
    if fmu.interface.fmi == 3:
        listed = sum(doc.size(doc.variables[unknown.key]) for unknown in doc.unknowns("EventIndicators"))
        with integrated(fmu) as host:
            host.start()
            if host.sizes[1] != listed:
                yield f"it has {host.sizes[1]} event indicators, and ModelStructure lists {listed}"
        return
    said = fmu.interface.description.numberOfEventIndicators
    taken = _taken(fmu, said)
    if taken is None:
        yield f"it writes more than {said} event indicators"
    others = [] if taken is not False else range(said + MOST_INDICATORS)
    if fitting := [number for number in others if number != said and _taken(fmu, number)]:
        yield f"it refuses {said} event indicators, the number that it says, and takes {fitting[0]}"


def _taken(fmu: Unpacked, number: int) -> bool | None:
    """Whether it takes that number; None if it writes more."""
    room = (c_double * (number + MOST_INDICATORS))(*[UNTOUCHED] * (number + MOST_INDICATORS))
    with instantiated("checked", fmu, exchanging=True) as instance:
        ExchangeHost(instance).start()
        try:
            instance.call("getEventIndicators", room, number)
        except SimulationError:
            return False
    return None if any(value != UNTOUCHED for value in room[number:]) else True
