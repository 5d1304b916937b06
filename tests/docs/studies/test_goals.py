"""What the controller is to reach: the runs that tell, the table of them, and which change would reach it."""

import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from docs.studies.goals import GOALS, MONTE_CARLO, UNITS, Goal, Reached, monte_carlo, most, reached, runs, title
from docs.studies.one_at_a_time import FACTORS, Change, changes, closest, harmless
from driveline.harness.design.search.tuning_runs import HELD_OUT_SEEDS, SLOW_MOTOR
from driveline.harness.design.uncertainty_box import NOMINAL
from driveline.harness.loop.places import PLANTS
from driveline.harness.loop.settings import Settings
from driveline.harness.metrics.run_metrics import Metrics
from fmuloop import many_runs

STEP = Goal("tipin15", "response_delay", (18, 27), over_none=True)
SLOW = Goal("tipin15", "overshoot", (22, 20), SLOW_MOTOR)


def metrics(**values: float) -> Any:
    return SimpleNamespace(**values)


def test_each_goal_is_a_metric_with_a_unit_told_by_noise_that_is_held_out() -> None:
    assert {goal.metric for goal in GOALS} == set(UNITS) <= set(Metrics.__dataclass_fields__)
    assert len(set(GOALS)) == len(GOALS) == len({title(goal) for goal in GOALS})
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


def test_what_is_reached_is_the_mean_magnitude_of_the_goals_own_runs_over_none() -> None:
    first, *_ = runs((SLOW,), (5,))
    found = {
        first: metrics(overshoot=-0.1),
        first._replace(seed=6): metrics(overshoot=0.3),
        first._replace(deviation=NOMINAL): metrics(overshoot=9.0),
        first._replace(plant=PLANTS[1]): metrics(overshoot=9.0),
        first._replace(control=False): metrics(overshoot=9.0),
    }
    assert reached(SLOW, PLANTS[0], found) == pytest.approx(20.0)  # per cent
    with_control = runs((STEP,), (5,))[0]
    found = {
        with_control: metrics(response_delay=0.060),
        with_control._replace(control=False): metrics(response_delay=0.044),
    }
    assert reached(STEP, PLANTS[0], found) == pytest.approx(16.0)  # ms


def test_the_monte_carlo_is_told_for_both_plants(native: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(many_runs, "cores", lambda: 1)
    settings = Settings(folder=native.parent, build="native")
    cells = monte_carlo(1, {}, settings)
    assert len(cells) == len(MONTE_CARLO) == len(PLANTS)
    assert all(re.fullmatch(r"100 %; 0\.\d\d / 0\.\d\d s", text) for text in cells)
    assert monte_carlo(1, {"k_d": 0.2}, settings) != cells


KEYS = [(goal, plant) for goal in GOALS for plant in PLANTS]
A, B, C = (Change(name, 1.0) for name in "abc")


def reaching(*shares: float) -> Reached:
    """These shares of the first goals, and half of the others."""
    values = {key: 0.5 * most(*key) for key in KEYS}
    return values | {key: share * most(*key) for key, share in zip(KEYS, shares, strict=False)}


BEFORE = reaching(2.0, 2.0, 0.9)


def test_the_change_that_reaches_a_goal_with_the_fewest_missed_instead_is_taken_or_the_closest() -> None:
    changed = {A: reaching(0.5, 2.0, 2.0), B: reaching(0.9, 2.0, 0.9), C: reaching(0.8, 2.0, 2.0, 2.0)}
    assert closest(KEYS[0], BEFORE, changed)[:2] == (B, 0.9 * most(*KEYS[0]))
    assert closest(KEYS[0], BEFORE, {A: changed[A], C: changed[C]}).instead == [KEYS[2]]
    assert closest(KEYS[0], BEFORE, {A: reaching(0.5, 3.0, 0.9)}).instead == []
    changed = {A: reaching(1.5, 2.0), B: reaching(1.2, 2.0, 2.0, 2.0), C: reaching(1.3)}
    assert closest(KEYS[0], BEFORE, changed).change == B


def test_a_change_is_harmless_that_misses_nothing_instead() -> None:
    one, both, costly = reaching(0.5, 2.0, 0.9), reaching(0.5, 0.5, 0.9), reaching(0.5, 0.5, 2.0)
    assert harmless(BEFORE, {A: one}) == harmless(BEFORE, {A: one, C: costly}) == 1
    assert harmless(BEFORE, {A: one, B: both}) == 2
    assert harmless(BEFORE, {C: costly}) == 0


def test_every_parameter_that_a_search_may_change_is_changed_by_each_factor() -> None:
    found = changes()
    assert len(set(found)) == len(found)
    assert len(found) == len(FACTORS) * len({change.parameter for change in found})
    assert Change("k_d", round(2.58 * 1.1, 6)) in [change._replace(value=round(change.value, 6)) for change in found]
