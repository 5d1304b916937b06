"""The bound of a manoeuvre stands beside a run that reaches it."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from docs.studies.bound import Bounded, bounded
from driveline.harness.loop.settings import Settings
from fmuloop.errors import SimulationError


@pytest.fixture(scope="module")
def found(native: Path) -> Iterator[Bounded]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("docs.studies.bound.ALONE", ("jerk_rms_to_50_Hz",))
        yield bounded("tipin0", Settings(folder=native.parent, build="native"))


@pytest.mark.slow
def test_nothing_is_better_than_the_bound_which_a_run_reaches_that_answers_the_driver(found: Bounded) -> None:
    ratio = found.ratio(found.jointly)
    assert found.bound - 1e-4 <= ratio <= found.bound + 0.005
    assert ratio < 1.0
    assert found.jointly.deviation < 0.01
    reached, best = found.task.reached, found.jointly.metrics
    assert best.response_delay == reached.response_delay
    assert abs(best.withheld_time) <= reached.withheld_time + 1e-5
    assert best.settling_time <= reached.settling_time
    assert abs(best.stationary_torque_change) < 1e-9


@pytest.mark.slow
def test_one_metric_alone_can_be_smaller_than_all_jointly_and_the_others_are_kept(found: Bounded) -> None:
    for name, optimum in found.alone.items():
        assert getattr(optimum.metrics, name) <= 1.001 * getattr(found.jointly.metrics, name)
        for other in found.task.metrics:
            assert getattr(optimum.metrics, other) <= 1.005 * getattr(found.task.reached, other)
        assert optimum.metrics.settling_time <= found.task.reached.settling_time


def test_what_the_controller_does_not_reach_is_no_bound(native: Path) -> None:
    """Undamped, with springs that hardly lose anything, the gear torque still swings when the run ends."""
    undamped = {"plant.c_slip": 1e6, "controller.k_d": 0.0}
    settings = Settings(folder=native.parent, build="native", parameters=undamped)
    with pytest.raises(SimulationError, match=r"tipin0: no bound without settling_time: .* still swings"):
        bounded("tipin0", settings)
