"""What a controller is tuned by, and what is held out."""

from dataclasses import fields

from driveline.harness.design.search.tuning_runs import (
    AT_CORNERS,
    HELD_OUT_MANOEUVRES,
    HELD_OUT_SEEDS,
    RUNS,
    SLOW_MOTOR,
)
from driveline.harness.design.uncertainty_box import BOX, NOMINAL
from driveline.harness.loop.places import PLANTS, T_S
from driveline.harness.manoeuvres.catalogue import COMPARED, USUAL_MANOEUVRES
from driveline.harness.manoeuvres.catalogue import MANOEUVRES as CATALOGUE

PART_OF_ANOTHER = {"prbs15"}


def test_every_usual_manoeuvre_is_driven_on_both_plants_or_held_out() -> None:
    for plant in PLANTS:
        in_runs = {run.name for run in RUNS if run.plant == plant and run.deviation == NOMINAL}
        assert in_runs.isdisjoint(HELD_OUT_MANOEUVRES)
        assert in_runs | {*HELD_OUT_MANOEUVRES} | PART_OF_ANOTHER == {each.name for each in USUAL_MANOEUVRES}
    assert {*COMPARED} & {*HELD_OUT_MANOEUVRES} == {"tipin50r"}


def test_no_run_has_a_held_out_manoeuvre_or_seed() -> None:
    assert HELD_OUT_SEEDS == (11, 12, 13)
    assert not {run.seed for run in RUNS} & {*HELD_OUT_SEEDS}
    assert not {run.name for run in RUNS} & {*HELD_OUT_MANOEUVRES}


def test_no_run_has_a_draw_from_inside_the_box() -> None:
    for run in RUNS:
        if run.deviation not in (NOMINAL, SLOW_MOTOR):
            assert all(getattr(run.deviation, name) in BOX[name] for name in BOX), run


def test_each_plant_stands_at_half_of_the_corners_with_the_manoeuvres_of_the_monte_carlo() -> None:
    for plant in PLANTS:
        at = [(run.deviation, run.name) for run in RUNS if run.plant == plant and run.deviation.loss]
        assert len(at) == len(set(at)) == 6 * len(AT_CORNERS)


def test_a_step_is_driven_as_long_as_its_metrics_need_and_others_whole() -> None:
    for run in RUNS:
        in_runs, whole = run.manoeuvre, CATALOGUE[run.name]
        assert in_runs.duration == (whole.duration if whole.dT is None else 3.0)
        assert all(getattr(in_runs, f.name) == getattr(whole, f.name) for f in fields(whole) if f.name != "duration")
        assert round(in_runs.duration / T_S) * T_S == in_runs.duration
