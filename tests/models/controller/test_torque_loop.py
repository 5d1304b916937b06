"""The torque that the motor should have: as the paper's eq. (1), and estimates just near enough to it and just not."""

import math
from math import cos, exp, sin, sqrt

import pytest

from driveline.models.controller import T_S, torque_loop
from driveline.models.controller.supervision import Parameters
from driveline.models.controller.torque_loop import LoopState
from tests.models.controller.controllers import each_side

P = Parameters(T_max=180.0, tau=0.003)


@pytest.mark.parametrize("tau", [0.0015, 0.003, 0.01, 0.1])
def test_it_answers_a_step_as_the_motor_does(tau: float) -> None:
    """To the error of the trapezoidal rule, at most a twelfth of (T_s/tau)^2 here."""
    x = LoopState(0.0, 0.0)
    for k in range(1, 30):
        x = torque_loop.update(x, 100.0, T_S, P._replace(tau=tau))
        a = k * T_S / (sqrt(2.0) * tau)
        assert x.T_mot == pytest.approx(
            100.0 * (1.0 - exp(-a) * (cos(a) + sin(a))), abs=100.0 * (T_S / tau) ** 2 / 12.0
        )


def test_a_sample_goes_as_the_trapezoidal_rule_has_it() -> None:
    """Means of the torque and of its rate over the sample are those in the middle, in both equations."""
    x, g = LoopState(20.0, 30.0), T_S / P.tau
    y = torque_loop.update(x, 100.0, T_S, P)
    T_mot, r = 0.5 * (x.T_mot + y.T_mot), 0.5 * (x.r + y.r)
    assert y.T_mot - x.T_mot == pytest.approx(g * r, rel=1e-12)
    assert y.r - x.r == pytest.approx(g * (100.0 - T_mot - sqrt(2.0) * r), rel=1e-12)


@each_side
@pytest.mark.parametrize(("T_mot", "most"), [(0.0, 9.0), (100.0, 44.0), (-100.0, 44.0)])
def test_an_estimate_may_differ_by_a_twentieth_of_T_max_and_a_third_of_the_torque(
    T_mot: float, most: float, side: float
) -> None:
    x = LoopState(T_mot, 0.0)
    assert torque_loop.agrees(x, T_mot + side * (most - 0.01), P)
    assert not torque_loop.agrees(x, T_mot + side * (most + 0.01), P)


def test_what_is_no_number_agrees_with_nothing() -> None:
    for signal in (math.nan, math.inf, -math.inf):
        assert not torque_loop.agrees(LoopState(0.0, 0.0), signal, P)
