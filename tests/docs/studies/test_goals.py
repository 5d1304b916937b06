"""What the controller is to reach: the runs that tell, and what the table makes of them."""

import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from docs.studies.goals import GOALS, MONTE_CARLO, UNITS, Goal, monte_carlo, reached, runs, title
from driveline.harness.design.search.tuning_runs import HELD_OUT_SEEDS, SLOW_MOTOR
from driveline.harness.design.uncertainty_box import NOMINAL
from driveline.harness.loop.places import PLANTS
from driveline.harness.loop.settings import Settings
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.simulation import many_runs

STEP = Goal("tipin15", "response_delay", (18, 27), over_none=True)
SLOW = Goal("tipin15", "overshoot", (22, 20), SLOW_MOTOR)


def metrics(**values: float) -> Any:
    return SimpleNamespace(**values)


def test_each_goal_is_a_metric_with_a_unit() -> None:
    assert {goal.metric for goal in GOALS} == set(UNITS) <= set(Metrics.__dataclass_fields__)
    assert len(set(GOALS)) == len(GOALS) == len({title(goal) for goal in GOALS})


def test_what_is_told_comes_from_noise_that_is_held_out() -> None:
    assert {run.seed for run in runs()} == {*HELD_OUT_SEEDS}


def test_each_run_is_made_once_and_without_control_where_that_counts() -> None:
    two = (SLOW, STEP, STEP._replace(metric="overshoot", over_none=False))
    found = runs(two, (5,))
    assert len(found) == len(set(found)) == 3 * len(PLANTS)
    assert {run[1:] for run in found} == {
        ("tipin15", SLOW_MOTOR, True, 5),
        ("tipin15", NOMINAL, True, 5),
        ("tipin15", NOMINAL, False, 5),
    }


def test_what_is_reached_is_the_mean_magnitude_of_the_goals_own_runs() -> None:
    first, *_ = runs((SLOW,), (5,))
    found = {
        first: metrics(overshoot=-0.1),
        first._replace(seed=6): metrics(overshoot=0.3),
        first._replace(deviation=NOMINAL): metrics(overshoot=9.0),
        first._replace(plant=PLANTS[1]): metrics(overshoot=9.0),
        first._replace(control=False): metrics(overshoot=9.0),
    }
    assert reached(SLOW, PLANTS[0], found) == pytest.approx(20.0)  # per cent


def test_what_control_adds_is_the_difference_to_none() -> None:
    with_control = runs((STEP,), (5,))[0]
    found = {
        with_control: metrics(response_delay=0.060),
        with_control._replace(control=False): metrics(response_delay=0.044),
    }
    assert reached(STEP, PLANTS[0], found) == pytest.approx(16.0)  # ms


def test_the_monte_carlo_is_told_for_both_plants(native: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(many_runs, "_cores", lambda: 1)
    settings = Settings(folder=native.parent, build="native")
    cells = monte_carlo(1, {}, settings)
    assert len(cells) == len(MONTE_CARLO) == len(PLANTS)
    assert all(re.fullmatch(r"100 %; 0\.\d\d / 0\.\d\d s", text) for text in cells)
    assert monte_carlo(1, {"k_d": 0.2}, settings) != cells
