"""What a torque has to keep, at its limits: neither withheld nor added, and settled with a reserve."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from docs.studies.optimal_torque.active_constraints import ActiveConstraints, settled_swing
from docs.studies.optimal_torque.constraints import programme
from docs.studies.optimal_torque.contacts import Contacts
from docs.studies.optimal_torque.linear_prediction import Horizon
from docs.studies.optimal_torque.programme import reached
from docs.studies.optimal_torque.task import Task
from driveline.harness.manoeuvres.manoeuvre import Manoeuvre
from driveline.harness.metrics.evaluate import T_S

SAMPLES = 1000
EARLY, LATE = 20, 200
"""Samples at which 90 % of the way are made, and from which on the gear torque has to be settled."""


class Rigid:
    """A drive train whose gear torque is the motor torque, with the teeth in contact."""

    phi = np.eye(1, 1 + SAMPLES).repeat(2, axis=0)

    def T_gear(self, samples: np.ndarray) -> np.ndarray:
        return np.eye(1 + SAMPLES)[1 + samples]

    def T_gear_parts(self) -> np.ndarray:
        raise AssertionError("of a task without this metric")

    jerk_parts = T_gear_parts


def given(dT: float, withheld_time: float = 1.0) -> Task:
    """A step of the demand by dT, of which so many seconds were withheld."""
    delay, settled = (EARLY + 1) * T_S, (LATE + 1) * T_S
    of: Any = SimpleNamespace(
        response_delay=delay,
        settling_time=settled,
        withheld_time=withheld_time,
        overshoot=0.0,
        impact_speed=0.0,
        gear_torque_rms=0.0,
        jerk_rms_to_50_Hz=0.0,
    )
    manoeuvre = Manoeuvre("step", "", 3.0, 0.0, lambda t: np.full_like(t, dT), t_0=1.0, dT=dT)
    nothing, limit = np.zeros(0), np.full(SAMPLES, 500.0)
    horizon = Horizon(np.full(SAMPLES, dT), SAMPLES, EARLY, nothing, nothing, 0)
    times = 1.0 + T_S * np.arange(1, SAMPLES + 1)
    return Task(manoeuvre, of, nothing, 0.0, dT, times, -limit, limit, horizon, Contacts((1,)))


def violated(task: Task, u: np.ndarray, *swings: tuple[int, int]) -> bool:
    """Whether a torque does not keep what it has to."""
    prediction: Any = Rigid()
    of = programme(task, prediction, task.contacts, 0.1, (), ActiveConstraints([EARLY], list(swings)))
    return reached(of, u)[1] > 0.0


@pytest.mark.parametrize("dT", [80.0, -130.0])
@pytest.mark.parametrize("withheld_time", [0.012, -0.004], ids=["withheld", "added"])
@pytest.mark.parametrize("side", [1.0, -1.0], ids=["less", "more"])
def test_neither_less_nor_more_torque_than_demanded_by_more_than_the_controller_withholds(
    dT: float, withheld_time: float, side: float
) -> None:
    """Else what is withheld at first could be added in excess later, or the other way round."""
    task = given(dT, withheld_time)
    for share, too_much in ((0.999, False), (1.001, True)):
        u = task.horizon.demand.copy()
        u[30:60] -= side * share * abs(withheld_time) * dT / T_S / 30.0
        assert violated(task, u) == too_much


@pytest.mark.parametrize("dT", [80.0, -130.0])
def test_a_torque_is_settled_that_swings_by_less_than_is_allowed_and_0_02_N_m(dT: float) -> None:
    task = given(dT)
    assert settled_swing(task) == pytest.approx(0.1 * abs(dT))
    for reserve, too_much in ((0.021, False), (0.019, True)):
        u = task.horizon.demand.copy()
        u[LATE + 50] += settled_swing(task) - reserve
        assert violated(task, u, (LATE + 10, LATE + 50)) == too_much
        assert not violated(task, u)


def test_90_percent_of_the_way_are_made_with_a_reserve_of_2_mN_m() -> None:
    task = given(80.0)
    for more, too_little in ((0.0021, False), (0.0019, True)):
        u = task.horizon.demand.copy()
        u[EARLY] = 72.0 + more
        assert violated(task, u) == too_little


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_swing_is_watched_that_eats_up_the_reserve(side: float) -> None:
    """By more than is worth watching, 0.005 N.m; at the samples between which it swings."""
    task = given(80.0)
    for reserve, swings in ((0.0151, False), (0.0149, True)):
        u = task.horizon.demand.copy()
        u[LATE + 50] += side * (settled_swing(task) - reserve)
        u[EARLY] += 20.0
        active = ActiveConstraints([EARLY])
        assert active.violated(task, u) == bool(active.swings) == swings
        for low, high in active.swings:
            assert (LATE + 50) in (low, high)
            assert u[high] - u[low] == pytest.approx(settled_swing(task) - reserve)
