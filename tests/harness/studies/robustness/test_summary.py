"""What a campaign says of each controller."""

from math import nan

import pytest

from driveline.harness.metrics.declaration import Column
from driveline.harness.studies.robustness.summary import Summary, goal, level_text, percent, summaries
from tests.harness.studies.robustness.outcomes import outcome

MS = Column("settling", "ms", 1e3, 0)


def summary(*outcomes):
    return Summary("TwoMassDriveline", "DampingController", "tipin15", outcomes)


def test_a_level_is_what_so_many_runs_do_not_exceed():
    twenty = summary(*(outcome(k, settling_time=0.01 * k) for k in range(1, 21)))
    assert twenty.level("settling_time", 0.5) == 0.1
    assert twenty.level("settling_time", 0.95) == 0.19


def test_a_level_counts_magnitudes_and_what_has_no_value_as_worst():
    four = summary(*(outcome(k, overshoot=value) for k, value in enumerate((-0.4, 0.1, nan, 0.2), 1)))
    assert four.level("overshoot", 0.5) == 0.2
    assert four.level("overshoot", 0.75) == 0.4
    assert level_text(four.level("overshoot", 0.95), MS) == "-"
    assert four.record["overshoot_1_95_percent"] is None
    assert four.record["overshoot_1_50_percent"] == 0.2


def test_shares_are_those_of_the_runs():
    three = summary(outcome(1), outcome(2, end_swing=50.0), outcome(3, overshoot=0.9))
    assert three.record["bounded_and_quiet"] == three.share("stable") == pytest.approx(2 / 3)
    assert three.record["good"] == pytest.approx(1 / 3)


def test_only_all_are_100_per_cent_and_only_none_0():
    assert [percent(share) for share in (1.0, 0.9999, 0.5, 0.0001, 0.0)] == ["100", "99.9", "50", "0.1", "0"]


def test_the_worst_settles_last_or_never():
    late, never, wild = (
        outcome(1, settling_time=3.0),
        outcome(2, settling_time=nan, end_swing=9.0),
        outcome(3, settling_time=nan, end_swing=10.0),
    )
    assert summary(late, outcome(4)).worst is late
    assert summary(wild, late, never).worst is wild


def test_summaries_are_by_manoeuvre_with_the_controllers_in_their_order():
    runs = [outcome(1, name, manoeuvre) for name in ("Mine", "Another") for manoeuvre in ("tipin15", "launch")]
    found = [(each.manoeuvre, each.controller, len(each.outcomes)) for each in summaries([*runs, *runs])]
    assert found == [(m, c, 2) for m in ("tipin15", "launch") for c in ("Mine", "Another")]


def test_the_goal_is_told_of_all_manoeuvres_and_the_settling_of_tip_in_and_launch():
    runs = [outcome(k, manoeuvre="tipin15", settling_time=0.214) for k in (1, 2)]
    runs += [outcome(k, manoeuvre="tipout", settling_time=0.9) for k in (1, 2)]
    runs += [outcome(k, manoeuvre="launch", settling_time=0.25, end_swing=70.0 * (k - 1)) for k in (1, 2)]
    assert goal(summaries(runs), "TwoMassDriveline", "DampingController") == "83.3 %; 0.21 / 0.25 s"
