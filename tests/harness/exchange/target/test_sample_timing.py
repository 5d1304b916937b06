"""The example with a timer: the sample is kept on the emulated target, and one that cannot be is seen."""

import pytest

from driveline.fmus.target.link import TargetError
from driveline.harness.exchange.target.c_export import with_values
from driveline.harness.exchange.target.programs import Programs
from driveline.harness.exchange.target.sample_timing import schedule
from driveline.models.controller.supervision import T_S

CLOCK = 25e6


@pytest.fixture
def sources(target: Programs) -> dict[str, str]:
    assert target
    return with_values("DampingController", "float", {})


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
