"""A search in its folder: recorded, resumed with the same bytes, and not mixed with another one."""

import json
from pathlib import Path

import pytest

from driveline.harness.design.search.controller_cost import Costs
from driveline.harness.design.search.cost_evaluation import CostEvaluation
from driveline.harness.design.search.parameter_search import Evaluated
from driveline.harness.design.search.search_space import space
from driveline.harness.design.search.tune import EVALUATIONS, RECORD, table, tune
from driveline.harness.design.search.tuning_runs import Run
from driveline.harness.design.uncertainty_box import NOMINAL
from driveline.harness.loop.settings import Settings
from driveline.harness.simulation.case_archive import CaseArchive
from fmuloop.errors import SimulationError
from toolground.errors import UserError

OURS = space("DampingController", {})
COUNT = 5


def searched(
    evaluation: CostEvaluation, folder: Path, count: int = COUNT, seed: int = 1, **settings: object
) -> list[Evaluated]:
    return tune(evaluation, OURS, count, seed, folder, **{"workers": 1, **settings})  # type: ignore[arg-type]


def test_what_is_known_is_not_run_again_and_the_record_tells_what_the_costs_depend_on(
    evaluation, tmp_path, monkeypatch
) -> None:
    searched(evaluation, tmp_path, count=1)
    assert sorted(path.name for path in tmp_path.iterdir()) == [EVALUATIONS, RECORD]
    run = json.loads((tmp_path / RECORD).read_text())["run"]
    assert run["controller"] == "DampingController"
    assert run["searched"]["k_d"] == [0.3, 2.58, 10.0]
    assert run["computed"]["lambda_v"] == 0.913
    assert run["reference"]["k_gap"] == 0.97
    assert {"TwoMassDriveline", "ValidationVehicle", "DampingController"} <= run["fmus"].keys()
    before = searched(evaluation, tmp_path)
    monkeypatch.setattr(CostEvaluation, "measured", lambda *_: pytest.fail("a run"))
    assert searched(evaluation, tmp_path) == before


def test_costs_come_back_from_the_file_to_the_last_bit(tmp_path: Path) -> None:
    path = tmp_path / "new" / "evaluations.csv"
    first, second = ((0.1, 1 / 3), Costs(1.0, 2 / 3, 0.1)), ((0.2, 2e-7), Costs(1e9, 1.0, 0.0))
    archive = CaseArchive(path, table(["k", "T"]))
    archive[first[0]] = first[1]
    assert dict(CaseArchive(path, table(["k", "T"]))) == dict([first])
    archive[second[0]] = second[1]
    assert dict(CaseArchive(path, table(["k", "T"]))) == dict([first, second])
    assert [p.name for p in path.parent.iterdir()] == ["evaluations.csv"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("k,swing,comfort,response\n", "its first line must be k,T,swing,comfort,response"),
        ("", "its first line must be k,T,swing,comfort,response"),
        ("k,T,swing,comfort,response\n1,2,3,4,5\n1,2,3,4\n", "line 3: it must have 5 finite numbers"),
        ("k,T,swing,comfort,response\n1,2,3,4,x\n", "line 2: it must have 5 finite numbers"),
        ("k,T,swing,comfort,response\n1,2,3,nan,5\n", "line 2: it must have 5 finite numbers"),
    ],
)
def test_a_file_that_is_none_of_a_search_is_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "evaluations.csv"
    path.write_text(text)
    with pytest.raises(UserError, match=message):
        CaseArchive(path, table(["k", "T"]))


SHORT = (Run("TwoMassDriveline", "tipin15", NOMINAL, 1, 1.0), Run("ValidationVehicle", "launch", NOMINAL, 2, 1.0))
SOFT, HARD = {"k_d": 1.5}, {"k_d": 3.0}


@pytest.fixture
def evaluation(native: Path) -> CostEvaluation:
    return CostEvaluation(Settings(folder=native.parent), runs=SHORT)


def test_the_designed_gains_of_a_car_cost_one_others_more_and_one_that_is_refused_is_named(
    evaluation: CostEvaluation, native: Path
) -> None:
    with evaluation.opened(workers=1) as costs_of:
        designed, soft = costs_of([evaluation.reference(), SOFT])
    assert designed == (1.0, 1.0, 1.0)
    assert soft.total() > 1.1
    car = {"J_1": 0.09, "C": 210.0}
    evaluation = CostEvaluation(Settings(folder=native.parent), car, runs=SHORT[:1])
    assert evaluation.reference()["k_d"] != pytest.approx(CostEvaluation().reference()["k_d"], rel=0.1)
    with evaluation.opened(workers=1) as costs_of:
        assert next(costs_of([evaluation.reference()])) == (1.0, 1.0, 1.0)
        assert next(costs_of([CostEvaluation().reference()])).total() != pytest.approx(1.0, abs=0.01)
    with evaluation.opened(workers=1) as costs_of, pytest.raises(SimulationError, match=r"tipin15 on .* k_d = -1"):
        next(costs_of([{"k_d": -1.0}]))
