"""A search in its folder: recorded, resumed with the same bytes, and not mixed with another one."""

import json
from pathlib import Path

import pytest

from driveline.harness.base.errors import DrivelineError
from driveline.harness.design.search.controller_cost import Costs
from driveline.harness.design.search.cost_evaluation import CostEvaluation
from driveline.harness.design.search.parameter_search import Evaluated, Search
from driveline.harness.design.search.search_space import space
from driveline.harness.design.search.tune import EVALUATIONS, RECORD, table, tune
from driveline.harness.design.search.tuning_runs import Run
from driveline.harness.design.uncertainty_box import NOMINAL
from driveline.harness.loop.settings import Settings
from driveline.harness.simulation.case_archive import CaseArchive

SHORT = (Run("TwoMassDriveline", "tipin15", NOMINAL, 1, 1.0), Run("TwoMassDriveline", "launch", NOMINAL, 2, 1.0))
OURS = space("DampingController", {})
COUNT = 12


@pytest.fixture
def evaluation(native: Path) -> CostEvaluation:
    return CostEvaluation(Settings(folder=native.parent), runs=SHORT)


def searched(
    evaluation: CostEvaluation, folder: Path, count: int = COUNT, seed: int = 1, **settings: object
) -> list[Evaluated]:
    return tune(evaluation, OURS, count, seed, folder, **{"workers": 1, **settings})  # type: ignore[arg-type]


@pytest.mark.slow
def test_a_search_is_the_same_on_any_number_of_cores(evaluation: CostEvaluation, tmp_path: Path) -> None:
    assert searched(evaluation, tmp_path / "1") == searched(evaluation, tmp_path / "2", workers=2)
    written = [(tmp_path / n / EVALUATIONS).read_bytes() for n in ("1", "2")]
    assert written[0] == written[1]
    assert sorted(path.name for path in (tmp_path / "1").iterdir()) == [EVALUATIONS, RECORD]


@pytest.mark.slow
def test_one_that_was_stopped_goes_on_and_ends_with_the_same_bytes(
    evaluation: CostEvaluation, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = searched(evaluation, tmp_path / "whole")
    with monkeypatch.context() as patch:
        patch.setattr(Search, "__init__", _stopping(Search.__init__, after=5))
        with pytest.raises(KeyboardInterrupt):
            searched(evaluation, tmp_path / "stopped")
    part = (tmp_path / "stopped" / EVALUATIONS).read_bytes()
    assert part.count(b"\n") == 1 + 5
    assert searched(evaluation, tmp_path / "stopped") == whole
    complete = (tmp_path / "stopped" / EVALUATIONS).read_bytes()
    assert complete == (tmp_path / "whole" / EVALUATIONS).read_bytes()
    assert complete.startswith(part)


def _stopping(begin, after):
    def started(self, space, costs_of, seed, known, note):
        def stop(count):
            note(count)
            if count == after:
                raise KeyboardInterrupt

        begin(self, space, costs_of, seed, known, stop)

    return started


def test_what_is_known_is_not_run_again(
    evaluation: CostEvaluation, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = searched(evaluation, tmp_path)
    monkeypatch.setattr(CostEvaluation, "measured", lambda *_: pytest.fail("a run"))
    assert searched(evaluation, tmp_path) == before


@pytest.mark.slow
def test_another_search_is_replaced_only_if_asked(evaluation: CostEvaluation, tmp_path: Path) -> None:
    searched(evaluation, tmp_path, count=3)
    before = (tmp_path / EVALUATIONS).read_bytes()
    with pytest.raises(DrivelineError, match=r"is of another run \(seed: 1 there, 2 here\)"):
        searched(evaluation, tmp_path, count=3, seed=2)
    assert (tmp_path / EVALUATIONS).read_bytes() == before
    anew = searched(evaluation, tmp_path, count=3, seed=2, replace=True)
    assert (tmp_path / EVALUATIONS).read_bytes().count(b"\n") == 1 + len(anew) == 4


def test_the_record_tells_what_the_costs_depend_on(evaluation: CostEvaluation, tmp_path: Path) -> None:
    searched(evaluation, tmp_path, count=1)
    run = json.loads((tmp_path / RECORD).read_text())["run"]
    assert run["controller"] == "DampingController"
    assert run["searched"]["k_d"] == [0.3, 2.55, 10.0]
    assert run["computed"]["lambda_v"] == 0.913
    assert run["reference"]["k_T"] == 0.003
    assert {"TwoMassDriveline", "ValidationVehicle", "DampingController"} <= run["fmus"].keys()


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
    with pytest.raises(DrivelineError, match=message):
        CaseArchive(path, table(["k", "T"]))
