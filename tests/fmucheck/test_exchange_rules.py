"""The checks of model exchange, and what feeds an FMU for rules: planted faults are found, none where there is none."""

import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from fmutesting.foreign import tampered
from fmutesting.foreign.oscillator import DESCRIPTION, WORDS_OF_FMI3, build_oscillator

from driveline.harness.loop.places import PLANTS
from fmucheck import exchange_host
from fmucheck.checking import check
from fmucheck.claim_rules import CLAIM_RULES, EXCHANGE_CLAIM_RULES
from fmucheck.exchange_host import integrated
from fmucheck.exchange_rules import EXCHANGE_RULES
from fmucheck.host import Host
from fmuloop.description import KINDS
from fmuloop.errors import WiringError
from fmuloop.interface import Interface
from fmuloop.limits import Limits
from fmuloop.unpacked_fmu import unpacked

NAMES = {rule.name for rule in EXCHANGE_RULES}


def errors(path, **options):
    """What was found, of each rule that is broken and an error."""
    found = check(path, **options)
    return {v.rule: "\n".join(v.problems) for v in found if v.problems and v.severity == "error"}


@pytest.mark.parametrize("fmi", [2, 3])
def test_an_fmu_for_model_exchange_alone_is_checked_and_in_order(tmp_path, fmi):
    verdicts = list(check(build_oscillator(tmp_path, fmi=fmi)))
    assert [v for v in verdicts if v.severity == "error" and v.problems] == []
    tried = {v.rule for v in verdicts if v.tried}
    assert tried >= NAMES
    assert not tried & {"runs", "steps", "reset", "instances", "states"}


def test_ours_is_in_order_without_co_simulation_too_and_a_loop_needs_it(native, tmp_path):
    def alone(xml):
        return re.sub("<CoSimulation.*?</CoSimulation>", "", xml, flags=re.DOTALL)

    path = tampered(native / f"{PLANTS[0]}.fmu", tmp_path / "alone.fmu", alone)
    assert [v for v in check(path) if v.problems] == []
    with pytest.raises(WiringError, match="is for model exchange alone; it must be for co-simulation"):
        Interface(build_oscillator(tmp_path))


@pytest.mark.parametrize(
    ("does", "rules", "finding"),
    [
        ({"IN_DERIVATIVES": "dx[1]=NAN"}, {"exchange-runs"}, r"der\(v\) is nan|CVode cannot integrate"),
        ({"IN_DERIVATIVES": "return 3"}, {"exchange-runs", "exchange-reset"}, "answered fmi2GetDerivatives with error"),
        ({"IN_DERIVATIVES": "if(now>0.5)return 3"}, {"exchange-runs"}, "answered fmi2GetDerivatives with error"),
        ({"IN_NEW_STATES": "info->needed=1"}, NAMES - {"exchange-states"}, "wants another iteration after 100 at 0 s"),
        ({"NOMINAL": "0.0"}, {"exchange-nominals"}, r"the nominal value of the state of der\(s\) is 0.0"),
        ({"NOMINAL": "-1.0"}, {"exchange-nominals"}, r"the nominal value of the state of der\(s\) is -1.0"),
        ({"RESET": "x[0]=x[0]"}, {"exchange-reset"}, "the run after fmi2Reset is another one"),
        ({"IN_DERIVATIVES": "exit(0)"}, {"exchange-runs"}, "exit code 0, in fmi2GetDerivatives"),
        ({"IN_DERIVATIVES": "for(;;){}"}, {"exchange-runs"}, "did not return from fmi2GetDerivatives"),
    ],
)
@pytest.mark.parametrize("fmi", [2, 3])
def test_a_fault_is_found(tmp_path, does, rules, finding, fmi):
    ignored = [rule.name for rule in (*CLAIM_RULES, *EXCHANGE_CLAIM_RULES)]
    found = errors(build_oscillator(tmp_path, fmi=fmi, **does), limits=Limits(call=0.5), ignored=ignored)
    for two, three in WORDS_OF_FMI3.items() if fmi == 3 else ():
        finding = finding.replace(two, three)
    assert rules <= found.keys() <= NAMES
    assert re.search(finding, found[min(rules)])


@pytest.mark.parametrize(
    ("pattern", "replacement", "finding"),
    [
        ('derivative="2"', 'derivative="1"', r"der\(v\) and der\(s\) are derivatives of s"),
        ('name="v" ', 'name="v" variability="discrete" ', r"der\(v\) is .* of v, which is no continuous Real"),
    ],
)
def test_a_derivative_is_that_of_one_continuous_state(tmp_path, pattern, replacement, finding):
    path = build_oscillator(tmp_path, DESCRIPTION.replace(pattern, replacement))
    assert re.search(finding, errors(path)["derivatives"])


EVENTS = "info->next_defined=1,info->next=now+0.1"


def events(path: Path, end: float) -> tuple[int, float, bool]:
    """How many there were up to a time, where the run is and whether it has ended."""
    with unpacked(Interface(path, kinds=list(KINDS))) as fmu, integrated(fmu) as host:
        host.start()
        host.advance(end)
        return host.events, host.time, host.ended


def test_each_time_event_is_one_up_to_the_last_that_a_run_may_have(tmp_path, monkeypatch) -> None:
    found = events(build_oscillator(tmp_path, IN_NEW_STATES=EVENTS), 0.35)
    assert found == (3, pytest.approx(0.35), False)
    monkeypatch.setattr(exchange_host, "MOST_EVENTS", 3)
    path = build_oscillator(tmp_path, IN_NEW_STATES=EVENTS)
    assert events(path, 0.25) == (2, pytest.approx(0.25), False)
    assert events(path, 0.95) == (3, pytest.approx(0.3), True)


def hosted(**experiment: str | None) -> Host:
    """An FMU without inputs, whose description proposes this; nothing if that is empty."""
    default = SimpleNamespace(**({"stepSize": None, "stopTime": None} | experiment)) if experiment else None
    description = SimpleNamespace(defaultExperiment=default)
    instance: Any = SimpleNamespace(
        interface=SimpleNamespace(description=description, rates={}, of_causality=lambda _: [])
    )
    return Host(instance)


@pytest.mark.parametrize(
    ("experiment", "step_size", "stop"),
    [
        ({}, 1e-3, 1.0),
        ({"stopTime": "5"}, 1e-3, 5.0),
        ({"stepSize": "0.02"}, 0.02, 1.0),
        ({"stepSize": "0.02", "stopTime": "5"}, 0.02, 5.0),
    ],
)
def test_the_steps_and_the_end_are_those_that_the_fmu_proposes(experiment, step_size, stop) -> None:
    host = hosted(**experiment)
    assert (host.step_size, host.stop) == (step_size, stop)


TENTHS = "info->next_defined=1,info->next=now+0.1,info->values_changed=1,x[1]+=now>0.05"
"""Time events; each changes the state, so that a run without it would go on otherwise."""


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("does", ["info->terminate=now>0.1", TENTHS], ids=["an end", "events"])
def test_an_end_that_the_fmu_wants_and_time_events_are_no_error(tmp_path, fmi, does):
    assert errors(build_oscillator(tmp_path, fmi=fmi, IN_NEW_STATES=does)) == {}
