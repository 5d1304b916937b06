"""Gains that are turned while the controller runs: nothing jumps in a steady state, and in a swing by no more than
the gain times what it is multiplied with."""

import math
import runpy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from driveline.fmus.catalogue import EVERY
from driveline.models.controller import T_S
from driveline.models.controller.supervision import FALLBACK, Input
from driveline.models.damping_controller import BLOCK
from fmublocks.block.types import SampledBlock
from fmublocks.description.variables import interface
from fmublocks.native.trace import leaves
from tests.models.controller.controllers import ROLLING

CYCLE = 10
"""Samples from one message to the next."""

LONG = 10000
"""Samples until nothing moves any more."""

TUNABLE = [v for v in interface(BLOCK) if v.variability == "tunable"]

STEADY = ("DampingController", "SpeedWashout", "SpeedDifference", "LinearObserver")


def parameters(block: SampledBlock, **values: float) -> Any:
    """A speed that stays the same is not frozen here, and a swing that lasts is not fed by the damping."""
    return block.Parameters(**{"frozen": 1000.0, "swing": 1.0, **values})


def rolling(k: int) -> Input:
    """A car that rolls evenly under a torque, with its messages."""
    return ROLLING._replace(counter=k // CYCLE)


def swinging(k: int) -> Input:
    """The same with a drive train that swings at 8 Hz."""
    return rolling(k)._replace(omega_1_meas=150.0 + 6.0 * math.sin(2.0 * math.pi * 8.0 * k * T_S))


def updated(block: SampledBlock, x: Any, u: Input, p: Any) -> Any:
    """The next state, the motor having the torque that is demanded of it."""
    return block.update(x, u._replace(T_mot_est=x.motor.loop.T_mot), p)


def settled(block: SampledBlock, signals: Callable[[int], Input], samples: int) -> Any:
    x, p = block.start(signals(0), parameters(block)), parameters(block)
    for k in range(samples):
        x = updated(block, x, signals(k), p)
    assert x.status != FALLBACK
    return x


@pytest.fixture(scope="module", params=STEADY)
def steady(request: pytest.FixtureRequest) -> tuple[SampledBlock, Any]:
    block: Any = EVERY[request.param].block
    return block, settled(block, rolling, LONG)


def test_in_a_steady_state_no_tunable_parameter_changes_the_torque(steady: tuple[SampledBlock, Any]) -> None:
    block, x = steady
    for variable in (v for v in interface(block) if v.variability == "tunable"):
        for value in variable.bounds():
            turned, p = x, parameters(block, **{variable.name: value})
            for k in range(LONG, LONG + 3):  # an estimator with gains of -2 is not stable
                turned = updated(block, turned, rolling(k), p)
                assert turned.T_ref == pytest.approx(50.0, abs=1e-6), (variable.name, value, k)


@pytest.mark.parametrize("k_d", [0.0, 1.5, 5.0, 200.0])
def test_in_a_swing_k_d_changes_the_torque_by_its_change_times_the_speed_difference(k_d: float) -> None:
    """That of the next sample, which the state keeps."""
    usual, x, steps = parameters(BLOCK, T_pred=T_S), settled(BLOCK, swinging, 400), []
    for k in range(400, 500):
        other = updated(BLOCK, x, swinging(k), usual._replace(k_d=k_d))
        x = updated(BLOCK, x, swinging(k), usual)
        e = x.estimator.estimate
        steps.append(abs(other.T_ref - x.T_ref))
        assert steps[-1] <= abs(k_d - usual.k_d) * abs(e.omega_1 - e.omega_2) + 1e-9
        assert 50.0 - usual.T_take_max <= other.T_ref <= 50.0 + usual.T_add_max
    assert max(steps) > abs(min(k_d, 5.0) - usual.k_d)


@pytest.mark.parametrize("variable", TUNABLE, ids=lambda v: v.name)
def test_at_both_ends_of_every_range_the_state_stays_finite_in_a_swing(variable: Any) -> None:
    x = settled(BLOCK, swinging, 300)
    for k in range(300, 400):
        p = parameters(BLOCK, **{variable.name: variable.bounds()[k % 2]})
        x = updated(BLOCK, x, swinging(k), p)
        assert all(map(math.isfinite, (*leaves(x.estimator), *x.law, x.T_ref)))
        assert abs(x.T_ref) <= p.T_max


def test_the_example_turns_the_gain_once_and_twice(native: Path) -> None:
    example = runpy.run_path(str(Path(__file__).parents[3] / "examples" / "turn_a_gain.py"))
    found = example["compared"](folder=native.parent)
    assert found["as designed"][1] == 0.0
    assert 20.0 < found["turned once"][1] < 60.0 < found["and back up"][1]
