"""The cost of a controller: ratios to a reference, by groups, and what the driver's choice makes of them."""

from dataclasses import replace
from math import nan

import pytest

from driveline.harness.design.search.controller_cost import LOST, TERMS, Costs, Term, costs, ratio
from driveline.harness.design.search.tuning_runs import LASTS, Run
from driveline.harness.design.uncertainty_box import NOMINAL
from driveline.harness.metrics.declaration import declared
from driveline.harness.metrics.run_metrics import Metrics

STEP, DRIVE = (Run("TwoMassDriveline", name, NOMINAL, 1, 1.0) for name in ("tipin15", "drive"))

FOUND = Metrics(
    settling_time=0.1,
    overshoot=0.2,
    damping_ratio=0.5,
    gear_torque_rms=4.0,
    jerk_rms=4.0,
    impact_speed=28.0,
    impact_speed_90=27.0,
    crossing_time=0.015,
    response_delay=0.06,
    withheld_time=0.012,
    stationary_torque_change=0.01,
    jerk_rms_to_50_Hz=5.0,
    added_torque_rms=5.0,
    added_torque_peak=90.0,
    gear_torque_peak=120.0,
    end_swing=0.1,
    plateau_swing=nan,
)


def cost_of(**changed: float) -> Costs:
    return costs([STEP], [replace(FOUND, **changed)], [FOUND])


def test_the_terms_are_metrics_and_count_all_that_is_asked_for() -> None:
    assert TERMS.keys() == set(Costs._fields)
    names = [term.metric for terms in TERMS.values() for term in terms]
    assert len(names) == len(set(names))
    assert set(names) <= {metric.name for metric in declared(Metrics)}
    assert set(names) >= {
        "settling_time", "overshoot", "response_delay", "withheld_time", "gear_torque_rms", "jerk_rms_to_50_Hz",
        "impact_speed", "plateau_swing",
    }  # fmt: skip


@pytest.mark.parametrize("character", [0.0, 0.3, 0.5, 1.0])
def test_the_reference_costs_one(character: float) -> None:
    assert cost_of() == pytest.approx((1.0, 1.0, 1.0))
    assert cost_of().total(character) == pytest.approx(1.0)


@pytest.mark.parametrize("term", [(group, term) for group, terms in TERMS.items() for term in terms])
def test_more_of_any_term_costs_more_in_its_group_alone(term: tuple[str, Term]) -> None:
    group, (metric, *_) = term
    reference = replace(FOUND, plateau_swing=0.2)
    worse = replace(reference, **{metric: 1.1 * getattr(reference, metric)})
    found = costs([STEP], [worse], [reference])
    assert {name for name in Costs._fields if getattr(found, name) > 1.0 + 1e-9} == {group}


def test_runs_and_terms_count_by_their_weights_and_worse_more_than_better() -> None:
    assert cost_of(withheld_time=-0.012, stationary_torque_change=-0.01) == cost_of()
    assert costs([STEP] * 2, [replace(FOUND, overshoot=0.2 + d) for d in (0.05, -0.05)], [FOUND] * 2).comfort > 1.0
    worse, light = replace(FOUND, overshoot=0.43), STEP._replace(weight=0.25)
    both = costs([STEP, light], [FOUND, worse], [FOUND, FOUND]).comfort
    assert both == pytest.approx(((1.0 + 1.0 + 0.25 * (2.0**4 + 1.0)) / 2.5) ** 0.25)


def test_small_differences_hardly_count_and_what_is_lacking_costs() -> None:
    term = Term("overshoot", 1.0, 0.03)
    reference = replace(FOUND, overshoot=0.0)
    assert ratio(term, STEP, replace(FOUND, overshoot=0.03), reference) == pytest.approx(2.0)
    assert ratio(term, STEP, replace(FOUND, overshoot=0.003), reference) == pytest.approx(1.1)
    term = Term("response_delay", 1.0, 0.0)
    assert ratio(term, STEP, FOUND, replace(FOUND, response_delay=nan)) is None
    assert ratio(term, STEP, replace(FOUND, response_delay=nan), FOUND) == LOST
    term = Term("settling_time", 1.0, 0.0)
    never = replace(FOUND, settling_time=nan)
    assert ratio(term, STEP, never, FOUND) == LASTS / 0.1
    assert ratio(term, STEP, never, never) == 1.0
    assert ratio(term, DRIVE, never, never) is None


def test_sport_pays_for_the_response_and_comfort_for_comfort() -> None:
    soft, quick = Costs(swing=1.0, comfort=0.9, response=1.1), Costs(swing=1.0, comfort=1.1, response=0.9)
    assert soft.total(1.0) < quick.total(1.0)
    assert soft.total(0.5) == pytest.approx(quick.total(0.5))
    assert soft.total(0.0) > quick.total(0.0)
    rising = [quick.total(k / 10) for k in range(11)]
    assert rising == sorted(rising)
