"""When a run is bounded, quiet and good, how it is kept, and what a campaign says of each controller."""

from math import inf, isnan, nan

import numpy as np
import pytest

from driveline.harness.metrics.declaration import Column
from driveline.harness.simulation.case_archive import CaseArchive
from driveline.harness.studies.robustness.outcome import METRICS, OVERSHOOTS, SETTLES, SHOWN, WITHHELD, Outcome
from driveline.harness.studies.robustness.robustness_campaign import RUNS
from driveline.harness.studies.robustness.robustness_figures import DRAWN, distributions
from driveline.harness.studies.robustness.summary import Summary, goal, level_text, percent, summaries
from driveline.harness.views.panels import Curve
from tests.harness.studies.robustness import GOOD, outcome
from toolground.errors import UserError

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


def test_a_run_is_good_by_magnitudes_and_without_a_value_the_worst():
    assert outcome(withheld_time=-2.0 * WITHHELD).good
    ended = Outcome(outcome().case, {metric.name: nan for metric in METRICS}, "the plant refused a step")
    assert not ended.bounded
    assert not ended.quiet
    assert not ended.good
    assert outcome(settling_time=nan).magnitude("settling_time") == inf
    assert outcome(stationary_torque_change=-0.5).magnitude("stationary_torque_change") == 0.5


MS = Column("settling", "ms", 1e3, 0)


def summary(*outcomes):
    return Summary("TwoMassDriveline", "DampingController", "tipin15", outcomes)


def test_a_level_is_the_magnitude_that_so_many_runs_do_not_exceed():
    twenty = summary(*(outcome(k, settling_time=0.01 * k) for k in range(1, 21)))
    assert twenty.level("settling_time", 0.5) == 0.1
    assert twenty.level("settling_time", 0.95) == 0.19
    four = summary(*(outcome(k, overshoot=value) for k, value in enumerate((-0.4, 0.1, nan, 0.2), 1)))
    assert four.level("overshoot", 0.5) == 0.2
    assert four.level("overshoot", 0.75) == 0.4
    assert level_text(four.level("overshoot", 0.95), MS) == "-"
    assert four.record["overshoot_1_95_percent"] is None
    assert four.record["overshoot_1_50_percent"] == 0.2


def test_shares_are_those_of_the_runs_and_only_all_are_100_per_cent():
    three = summary(outcome(1), outcome(2, end_swing=50.0), outcome(3, overshoot=0.9))
    assert three.record["bounded_and_quiet"] == three.share("stable") == pytest.approx(2 / 3)
    assert three.record["good"] == pytest.approx(1 / 3)
    assert [percent(share) for share in (1.0, 0.9999, 0.5, 0.0001, 0.0)] == ["100", "99.9", "50", "0.1", "0"]


def test_the_worst_settles_last_or_never():
    late, never, wild = (
        outcome(1, settling_time=3.0),
        outcome(2, settling_time=nan, end_swing=9.0),
        outcome(3, settling_time=nan, end_swing=10.0),
    )
    assert summary(late, outcome(4)).worst is late
    assert summary(wild, late, never).worst is wild


def test_summaries_are_by_manoeuvre_and_the_goal_is_told_of_all():
    runs = [outcome(1, name, manoeuvre) for name in ("Mine", "Another") for manoeuvre in ("tipin15", "launch")]
    found = [(each.manoeuvre, each.controller, len(each.outcomes)) for each in summaries([*runs, *runs])]
    assert found == [(m, c, 2) for m in ("tipin15", "launch") for c in ("Mine", "Another")]
    runs = [outcome(k, manoeuvre="tipin15", settling_time=0.214) for k in (1, 2)]
    runs += [outcome(k, manoeuvre="tipout", settling_time=0.9) for k in (1, 2)]
    runs += [outcome(k, manoeuvre="launch", settling_time=0.25, end_swing=70.0 * (k - 1)) for k in (1, 2)]
    assert goal(summaries(runs), "TwoMassDriveline", "DampingController") == "83.3 %; 0.21 / 0.25 s"


FIRST = ",".join(RUNS.columns)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a,b\n1,2\n", "its first line must be plant,controller,number,manoeuvre,settling_time_s,"),
        (f"{FIRST}\nTwoMassDriveline,1\n", "line 2: it must have the columns of the first line"),
        (f"{FIRST}\n" + ",".join(["x"] * len(RUNS.columns)) + "\n", "line 2: it must have the columns"),
    ],
)
def test_a_file_of_something_else_is_refused(tmp_path, text, message):
    path = tmp_path / "runs.csv"
    path.write_text(text)
    with pytest.raises(UserError, match=message):
        CaseArchive(path, RUNS)


CONTROLLERS = "DampingController", "NoDamping"


def test_each_metric_has_a_panel_with_the_shares_of_all_controllers() -> None:
    outcomes = [outcome(k, name, settling_time=0.1 * k) for name in CONTROLLERS for k in (2, 1, 4)]
    panels = distributions(summaries(outcomes), "tipin15")
    assert [panel.heading for panel in panels] == ["tipin15", *[""] * (len(DRAWN) - 1)]
    for panel, metric in zip(panels, DRAWN, strict=True):
        assert panel.x is not None
        assert SHOWN[metric].printed_unit in panel.x.label
        assert panel.ticks[95.0] == "95"
        curves = [part for part in panel.parts if isinstance(part, Curve)]
        assert [curve.label for curve in curves] == list(CONTROLLERS)
        np.testing.assert_allclose(curves[0].y, [0.0, 100.0 / 3.0, 200.0 / 3.0, 100.0])
    settling = panels[list(DRAWN).index("settling_time")].parts[0]
    assert isinstance(settling, Curve)
    assert settling.x[1:] == pytest.approx(np.array([0.1, 0.2, 0.4]) * SHOWN["settling_time"].factor)


def test_runs_are_kept_with_all_digits_and_the_reason_of_one_that_an_fmu_ended(tmp_path):
    runs = outcome(1, settling_time=0.1 + 0.2), outcome(2, "SpeedWashout", overshoot=nan)
    ended = Outcome(outcome(3).case, GOOD, 'plant refused a step, "too stiff"')
    archive = CaseArchive(tmp_path / "runs.csv", RUNS)
    for each in (*runs, ended):
        archive[each.case] = each
    found = CaseArchive(tmp_path / "runs.csv", RUNS)
    assert list(found) == [each.case for each in (*runs, ended)]
    assert found[runs[0].case] == runs[0]
    assert isnan(found[runs[1].case].measured["overshoot"])
    assert found[ended.case] == ended
