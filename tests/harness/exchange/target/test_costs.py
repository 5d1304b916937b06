"""What the controller takes of its processor: memory, and its time under a timer, where the sample is kept."""

from contextlib import nullcontext
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from driveline.fmus.native.statements import SINGLE
from driveline.fmus.target.link import TargetError
from driveline.fmus.target.sources import CONTROLLERS, target_sources
from driveline.harness.exchange.target import costs
from driveline.harness.exchange.target.controllers import Programs
from driveline.harness.exchange.target.costs import schedule
from driveline.models.controller import T_S

CLOCK = 25e6


@pytest.fixture
def sources(target: Programs) -> dict[str, str]:
    assert target
    return target_sources(CONTROLLERS["DampingController"], SINGLE)


def with_loop_in_update(sources: dict[str, str], rounds: int) -> dict[str, str]:
    """The controller with that much more to do in every sample."""
    loop = f"for (volatile int k = 0; k < {rounds}; k++) {{}}"
    head, update, body = sources["damping_controller.c"].partition("void damping_controller_update")
    return {**sources, "damping_controller.c": head + update + body.replace("{\n", f"{{\n{loop}\n", 1)}


def test_the_sample_is_kept(sources: dict[str, str]) -> None:
    found = schedule(sources)
    assert (found.samples, found.missed) == (5000, 0)
    assert found.period == round(T_S * CLOCK)
    assert 0 < found.latency < found.response < 0.25 * found.period
    assert found.period <= found.watchdog < 2 * found.period


def test_a_controller_that_takes_longer_responds_later(sources: dict[str, str]) -> None:
    usual, slower = schedule(sources), schedule(with_loop_in_update(sources, 1000))
    assert slower.missed == 0
    assert slower.response > usual.response + 2000


def test_the_watchdog_ends_one_that_takes_longer_than_a_sample(sources: dict[str, str]) -> None:
    """Its interrupt, the NMI, is a fault to this board."""
    with pytest.raises(TargetError, match="crashed: exit code 3"):
        schedule(with_loop_in_update(sources, 5000))


def test_memory_is_counted_in_numbers_of_four_bytes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Two states: the old one and the next."""
    monkeypatch.setattr(costs, "_flash", lambda path: {"law.o": 100, "image.elf": 250}[path.name])
    (tmp_path / "law.su").write_text("a.c:1:f\t16\tstatic\na.c:9:g\t48\tstatic\n", encoding="utf-8")
    (tmp_path / "image.map").write_text("/lib/libm.a(lib_a-sqrt.o)\n/lib/libc.a(lib_a-memcpy.o)\n", encoding="utf-8")
    link: Any = nullcontext(SimpleNamespace(states=40, inputs=7, outputs=5, parameters=30))
    found = costs.size_of(Programs(lambda: link, lambda: link, lambda: link, tmp_path / "image.elf", "law"))
    assert found == costs.Size(100, 250, 4 * (2 * 40 + 7 + 5), 4 * 30, 48, ("memcpy", "sqrt"))
