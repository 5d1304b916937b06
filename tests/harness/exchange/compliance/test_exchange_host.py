"""What integrates an FMU for the rules of model exchange."""

from pathlib import Path

import pytest

from driveline.harness.cosimulation.description import KINDS
from driveline.harness.cosimulation.interface import Interface
from driveline.harness.cosimulation.unpacked_fmu import unpacked
from driveline.harness.exchange.compliance import exchange_host
from driveline.harness.exchange.compliance.exchange_host import integrated
from tests.foreign.oscillator import build_oscillator

EVENTS = "info->next_defined=1,info->next=now+0.1"


def events(path: Path, end: float) -> tuple[int, float, bool]:
    """How many there were up to a time, where the run is and whether it has ended."""
    with unpacked(Interface(path, kinds=list(KINDS))) as fmu, integrated(fmu) as host:
        host.start()
        host.advance(end)
        return host.events, host.time, host.ended


def test_each_time_event_is_one(tmp_path: Path) -> None:
    found = events(build_oscillator(tmp_path, IN_NEW_STATES=EVENTS), 0.35)
    assert found == (3, pytest.approx(0.35), False)


def test_a_run_ends_at_the_last_event_that_it_may_have(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(exchange_host, "MOST_EVENTS", 3)
    path = build_oscillator(tmp_path, IN_NEW_STATES=EVENTS)
    assert events(path, 0.25) == (2, pytest.approx(0.25), False)
    assert events(path, 0.95) == (3, pytest.approx(0.3), True)
