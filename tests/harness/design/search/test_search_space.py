"""What is searched follows from the declaration of the parameters, by which runs it is tuned, and what is held out."""

from dataclasses import fields
from typing import Any

import numpy as np
import pytest

from driveline.fmus.building.parameter_files import of_plants, read_vehicle
from driveline.fmus.catalogue import EVERY
from driveline.harness.design.design import AUTHORITY, design, literal_observer
from driveline.harness.design.design_weights import records
from driveline.harness.design.search.controller_cost import Costs
from driveline.harness.design.search.parameter_search import Evaluated
from driveline.harness.design.search.pareto_figure import MARGIN, front_drawing
from driveline.harness.design.search.search_space import Searched, Space, space
from driveline.harness.design.search.tuning_runs import (
    AT_CORNERS,
    HELD_OUT_MANOEUVRES,
    HELD_OUT_SEEDS,
    RUNS,
    SLOW_MOTOR,
)
from driveline.harness.design.uncertainty_box import BOX, NOMINAL
from driveline.harness.loop.places import PLACES, PLANTS, T_S
from driveline.harness.manoeuvres.catalogue import COMPARED, USUAL_MANOEUVRES
from driveline.harness.manoeuvres.catalogue import MANOEUVRES as CATALOGUE
from driveline.harness.views.panels import Curve
from fmublocks.block.declaration import Real, variables
from tests import ROOT

OURS = "DampingController"
TUNED = [name for name in PLACES["controller"] if name != "NoDamping"]
VAN = read_vehicle(ROOT / "examples" / "cars" / "van.toml")


def declared(controller: str) -> dict[str, Any]:
    return {v.name: v for v in variables(EVERY[controller].block.Parameters)}


@pytest.mark.parametrize("controller", TUNED)
def test_what_is_declared_with_a_range_is_searched_from_its_start_within_the_bounds(controller: str) -> None:
    found = {each.name: each for each in space(controller, {}).searched}
    ranges = {
        name: v.declaration.search
        for name, v in declared(controller).items()
        if isinstance(v.declaration, Real) and v.declaration.search
    }
    assert found.keys() == ranges.keys()
    for name, each in found.items():
        assert (each.low, each.high) == pytest.approx(ranges[name])
        assert each.start == pytest.approx(declared(controller)[name].start, rel=1e-5)
    for name, v in declared(controller).items():
        if isinstance(v.declaration, Real) and v.declaration.search:
            low, high = v.declaration.search
            assert v.declaration.minimum <= low < v.start < high <= v.declaration.maximum, name
            assert name not in of_plants()


def test_our_law_is_searched_from_what_the_formulas_make_of_the_car() -> None:
    found = space(OURS, {})
    assert {each.name for each in found.searched} >= {"k_d", "shape_2", "omega_w", "T_gap"}
    assert found.computed.keys() == design().keys() - {each.name for each in found.searched}
    assert {"lambda_v", "L_phi", "Ls_phi", "L_can_phi"} <= found.computed.keys()
    designed = design(VAN)
    found = space(OURS, VAN)
    assert found.parameters(found.start) == pytest.approx(designed, rel=1e-5)
    k_d = next(each for each in found.searched if each.name == "k_d")
    assert k_d.high / k_d.start == pytest.approx(10.0 / design()["k_d"], rel=1e-5)


def test_others_take_what_they_have_in_common_with_ours_and_the_paper_s_observer_its_own_gains() -> None:
    usual, of_van = space("LinearObserver", {}), space("LinearObserver", VAN)
    assert of_van.computed["L_phi"] == space(OURS, VAN).computed["L_phi"] != usual.computed["L_phi"]
    washout = space("SpeedWashout", VAN)
    assert [each.name for each in washout.searched] == ["k_v", "omega_v", "zeta_v"]
    assert washout.computed.keys() == set(AUTHORITY)
    usual, of_van = space("PaperObserver", {}), space("PaperObserver", VAN)
    estimator = {name for name in declared("PaperObserver") if name.startswith("L")}
    assert usual.computed == {name: declared("PaperObserver")[name].start for name in (*estimator, "T_age", *AUTHORITY)}
    assert of_van.computed.keys() == usual.computed.keys()
    assert of_van.computed["L_phi"] == pytest.approx(literal_observer(*records(VAN))["L_phi"], rel=1e-5)
    assert of_van.computed["L_phi"] != pytest.approx(usual.computed["L_phi"], rel=0.01)


@pytest.mark.parametrize("each", [Searched("k", 2.0, 0.2, 10.0), Searched("T", 0.004, 0.0, 0.012)])
def test_a_coordinate_is_zero_at_the_start_and_ends_with_the_range(each: Searched) -> None:
    assert each.coordinate(each.start) == 0.0
    assert each.value(0.0) == each.start
    for value in (each.low, 0.9 * each.start, each.high):
        assert each.value(each.coordinate(value)) == pytest.approx(value, rel=1e-5)
    assert each.value(99.0) == each.high
    assert each.value(-99.0) == each.low


def test_coordinates_go_by_factors_above_zero_else_by_halves_with_the_digits_of_a_file() -> None:
    assert Searched("k", 2.0, 0.2, 10.0).value(1.0) == pytest.approx(2.0 * 2.718282, rel=1e-5)
    assert Searched("T", 0.004, 0.0, 0.012).value(1.0) == pytest.approx(0.01)
    assert Searched("k", 2.0, 0.2, 10.0).value(0.1) == 2.21034


PART_OF_ANOTHER = {"prbs15"}


def test_every_usual_manoeuvre_is_driven_on_both_plants_or_held_out_as_long_as_needed() -> None:
    for plant in PLANTS:
        in_runs = {run.name for run in RUNS if run.plant == plant and run.deviation == NOMINAL}
        assert in_runs.isdisjoint(HELD_OUT_MANOEUVRES)
        assert in_runs | {*HELD_OUT_MANOEUVRES} | PART_OF_ANOTHER == {each.name for each in USUAL_MANOEUVRES}
    assert {*COMPARED} & {*HELD_OUT_MANOEUVRES} == {"tipin50r"}
    for run in RUNS:
        in_runs, whole = run.manoeuvre, CATALOGUE[run.name]
        assert in_runs.duration == (whole.duration if whole.dT is None else 3.0)
        assert all(getattr(in_runs, f.name) == getattr(whole, f.name) for f in fields(whole) if f.name != "duration")
        assert round(in_runs.duration / T_S) * T_S == in_runs.duration


def test_no_run_has_a_held_out_manoeuvre_or_seed_or_a_draw_from_inside_the_box() -> None:
    assert HELD_OUT_SEEDS == (11, 12, 13)
    assert not {run.seed for run in RUNS} & {*HELD_OUT_SEEDS}
    assert not {run.name for run in RUNS} & {*HELD_OUT_MANOEUVRES}
    for run in RUNS:
        if run.deviation not in (NOMINAL, SLOW_MOTOR):
            assert all(getattr(run.deviation, name) in BOX[name] for name in BOX), run
    for plant in PLANTS:
        at = [(run.deviation, run.name) for run in RUNS if run.plant == plant and run.deviation.loss]
        assert len(at) == len(set(at)) == 6 * len(AT_CORNERS)


def test_the_figure_shows_every_parameter_that_is_searched_in_a_style_of_its_own() -> None:
    searched = tuple(Searched(f"k_{k}", 1.0 + k, 0.1, 100.0) for k in range(16))
    visited = [Evaluated(tuple(f * each.start for each in searched), Costs(1.0, f, 2.0 - f)) for f in (1.0, 0.8, 1.2)]
    drawn = front_drawing(visited, Space(searched, {}), {"comfort": 1.0}, "a search")
    curves = [part for part in drawn.rows[1][0].parts if isinstance(part, Curve)]
    assert [curve.label for curve in curves] == [each.name for each in searched]
    assert len({(curve.color, curve.dashes) for curve in curves}) == 16
    assert all(set(np.round(curve.y, 9)) <= {0.8, 1.0, 1.2} for curve in curves)
    (costs,) = drawn.rows[0]
    assert costs.x
    assert costs.x.window == pytest.approx((0.8 - 0.2 * MARGIN, 1.0 + 0.2 * MARGIN)), "from the start to what is marked"
