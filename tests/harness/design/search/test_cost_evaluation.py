"""Costs: the same candidates cost the same, in any company and on any number of cores."""

from pathlib import Path

import pytest

from driveline.harness.base.errors import SimulationError
from driveline.harness.design.search.cost_evaluation import CostEvaluation
from driveline.harness.design.search.tuning_runs import Run
from driveline.harness.design.uncertainty_box import NOMINAL
from driveline.harness.loop.settings import Settings

SHORT = (Run("TwoMassDriveline", "tipin15", NOMINAL, 1, 1.0), Run("ValidationVehicle", "launch", NOMINAL, 2, 1.0))
SOFT, HARD = {"k_d": 1.5}, {"k_d": 3.0}


@pytest.fixture
def evaluation(native: Path) -> CostEvaluation:
    return CostEvaluation(Settings(folder=native.parent), runs=SHORT)


def test_the_designed_gains_cost_one_and_others_cost_otherwise(evaluation: CostEvaluation) -> None:
    with evaluation.opened(workers=1) as costs_of:
        designed, soft = costs_of([evaluation.reference(), SOFT])
    assert designed == (1.0, 1.0, 1.0)
    assert soft.total() > 1.1


@pytest.mark.slow
def test_what_a_candidate_costs_depends_on_nothing_else(evaluation: CostEvaluation) -> None:
    with evaluation.opened(workers=1) as costs_of:
        alone = [next(costs_of([candidate])) for candidate in (SOFT, HARD)]
    with evaluation.opened(workers=2) as costs_of:
        assert [*costs_of([HARD, SOFT, HARD])] == [alone[1], alone[0], alone[1]]
        assert [*costs_of([SOFT])] == alone[:1]


def test_a_car_has_its_own_reference(native: Path) -> None:
    car = {"J_1": 0.09, "C": 210.0}
    evaluation = CostEvaluation(Settings(folder=native.parent), car, runs=SHORT[:1])
    assert evaluation.reference()["k_d"] != pytest.approx(CostEvaluation().reference()["k_d"], rel=0.1)
    with evaluation.opened(workers=1) as costs_of:
        assert next(costs_of([evaluation.reference()])) == (1.0, 1.0, 1.0)
        assert next(costs_of([CostEvaluation().reference()])).total() != pytest.approx(1.0, abs=0.01)


def test_a_candidate_that_is_refused_is_named(evaluation: CostEvaluation) -> None:
    with evaluation.opened(workers=1) as costs_of, pytest.raises(SimulationError, match=r"tipin15 on .* k_d = -1"):
        next(costs_of([{"k_d": -1.0}]))
