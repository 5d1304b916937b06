"""Rules for what an FMU does in model exchange. Each function is given it unpacked."""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from math import isfinite

from fmuloop.unpacked_fmu import Unpacked

from .document import document
from .exchange_host import ExchangeHost, integrated
from .rule import Clause, Rules, Severity

POINTS = 100
"""Of a run, at which states, derivatives and event indicators are looked at."""

PART = 0.02
"""Of the default experiment, which is run for a comparison, or quickly."""

Point = tuple[float, list[float], list[float]]
"""A time, states, derivatives."""


def _run(host: ExchangeHost, share: float, points: int) -> list[Point]:
    track: list[Point] = []
    begin = host.time
    for k in range(1, points + 1):
        host.advance(begin + share * host.duration * k / points)
        track.append((host.time, host.states(), host.rates()))
    return track


def _names(host: ExchangeHost) -> list[str]:
    """Those of the derivatives."""
    variables = [unknown.variable for unknown in host.instance.interface.description.derivatives]
    names = [str(variable.name) if variable else "a derivative" for variable in variables]
    return names if len(names) == host.sizes[0] else [f"derivative {k}" for k in range(1, host.sizes[0] + 1)]


def _not_finite(host: ExchangeHost, points: list[Point]) -> Iterator[str]:
    for time, _, rates in points:
        for name, value in zip(_names(host), rates, strict=True):
            if not isfinite(value):
                yield f"{name} is {value} at {time:g} s"
                return


EXCHANGE_RULES = Rules()


@EXCHANGE_RULES.rule(
    "exchange-runs",
    Severity.ERROR,
    "in model exchange the default experiment runs, all values are finite",
    Clause("3.2.2", "3.2.1"),
    others="FMUChecker",
)
def default_experiment(fmu: Unpacked, share: float = 1.0) -> Iterator[str]:
    """Integrates the default experiment; an FMU may end it (terminateSimulation)."""
    with integrated(fmu) as host:
        host.start()
        points = _run(host, share, POINTS)
        for k, value in enumerate(host.indicators()):
            if not isfinite(value):
                yield f"event indicator {k + 1} is {value} at {host.time:g} s"
        yield from _not_finite(host, points)


@EXCHANGE_RULES.rule(
    "exchange-nominals", Severity.ERROR, "nominal values of the states are above 0", Clause("3.2.2", "2.3.3")
)
def nominals(fmu: Unpacked) -> Iterator[str]:
    """What a solver divides by."""
    with integrated(fmu) as host:
        host.start()
        for name, value in zip(_names(host), host.nominals(), strict=True):
            if not (isfinite(value) and value > 0.0):
                yield f"the nominal value of the state of {name} is {value}"


@EXCHANGE_RULES.rule(
    "exchange-reset", Severity.ERROR, "in model exchange a second run after reset is the same", Clause("2.1.6", "2.3.1")
)
def repeats_after_reset(fmu: Unpacked) -> Iterator[str]:
    """The same run before and after a reset."""
    with integrated(fmu) as host:
        host.start()
        first = _run(host, PART, POINTS)
        host.instance.call("reset")
        host.begin_anew()
        host.start()
        if _run(host, PART, POINTS) != first:
            yield f"the run after fmi{fmu.interface.fmi}Reset is another one"


@EXCHANGE_RULES.rule(
    "exchange-states",
    Severity.ERROR,
    "in model exchange saved states are restored, if it claims so",
    Clause("2.1.8", "2.2.7.4"),
)
def states_are_restored(fmu: Unpacked) -> Iterator[str]:
    """Time, states and derivatives of a saved state."""
    if not document(fmu.interface).claims("canGetAndSetFMUState", "ModelExchange"):
        return
    with integrated(fmu) as host:
        host.start()
        _run(host, PART, 1)
        if host.ended:
            return
        saved = host.instance.call("getFMUstate")
        before = host.states(), host.rates()
        _run(host, PART, 1)
        host.instance.call("setFMUstate", saved)
        host.instance.call("freeFMUstate", saved)
        if (host.states(), host.rates()) != before:
            yield "states and derivatives are not those that were saved"


QUICK_EXCHANGE_RULES = [
    replace(rule, problems=partial(default_experiment, share=PART))
    for rule in EXCHANGE_RULES
    if rule.problems is default_experiment
]
"""The first part of the default experiment."""
