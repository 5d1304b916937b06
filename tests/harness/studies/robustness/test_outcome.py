"""When a run is bounded, quiet and good."""

from math import inf, nan

import pytest

from driveline.harness.studies.robustness.outcome import METRICS, OVERSHOOTS, SETTLES, WITHHELD, Outcome
from tests.harness.studies.robustness.outcomes import outcome

STEP = 112.0
"""Of tipin15, N.m."""


@pytest.mark.parametrize(("metric", "limit"), [("gear_torque_peak", 2.0), ("end_swing", 0.05 * STEP)])
def test_beyond_the_limit_a_run_is_neither_stable_nor_good(metric, limit):
    within, beyond = (outcome(**{metric: factor * limit}) for factor in (1.0 - 1e-9, 1.0 + 1e-9))
    assert within.stable
    assert within.good
    assert not beyond.stable
    assert not beyond.good
    assert (beyond.bounded, beyond.quiet) == (metric != "gear_torque_peak", metric != "end_swing")


@pytest.mark.parametrize(
    ("metric", "limit"), [("settling_time", SETTLES), ("overshoot", OVERSHOOTS), ("withheld_time", WITHHELD)]
)
def test_beyond_the_limit_a_run_is_stable_but_not_good(metric, limit):
    assert outcome(**{metric: limit}).good
    for value in (limit * (1.0 + 1e-9), nan):
        assert outcome(**{metric: value}).stable
        assert not outcome(**{metric: value}).good


def test_torque_that_is_added_is_not_withheld():
    assert outcome(withheld_time=-2.0 * WITHHELD).good


def test_a_run_without_metrics_is_neither_bounded_nor_quiet():
    ended = Outcome(outcome().case, {metric.name: nan for metric in METRICS}, "the plant refused a step")
    assert not ended.bounded
    assert not ended.quiet
    assert not ended.good


def test_what_has_no_value_is_the_worst():
    assert outcome(settling_time=nan).magnitude("settling_time") == inf
    assert outcome(stationary_torque_change=-0.5).magnitude("stationary_torque_change") == 0.5
