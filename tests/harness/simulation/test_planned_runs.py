"""Cases that plan their runs and judge the results: in lanes with the answers of single runs."""

import os
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from shutil import copytree
from unittest.mock import Mock

import numpy as np
import pytest

from driveline.harness.loop.lane_libraries import _library
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import planned, simulate
from fmuloop import campaign, many_runs
from fmuloop.campaign import RunRequest
from fmuloop.errors import SimulationError, WiringError
from fmuloop.many_runs import many, run_many
from fmuloop.master import Loop
from fmuloop.results import Results
from toolground.lanes_here import lanes_here

TIPIN = replace(MANOEUVRES["tipin15"], duration=0.2)


@pytest.fixture
def lanes(monkeypatch, tmp_path):
    """Lanes for four cases and more, and a cache of their own."""
    if not lanes_here():
        pytest.skip("this processor has no lanes")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(many_runs, "MANY", 4)


@pytest.fixture
def in_lanes(monkeypatch):
    """How many runs were made at a time."""
    counts: list[int] = []
    run = campaign.LaneLoop.run

    def counted(self, loop, experiments):
        counts.append(len(experiments))
        return run(self, loop, experiments)

    monkeypatch.setattr(campaign.LaneLoop, "run", counted)
    return counts


def swing(folder: Path):
    """The plan and the judge of two runs with other noise."""

    def runs(case: tuple[str, int]) -> list[RunRequest]:
        plant, seed = case
        return [planned(TIPIN, plant, seed=each, folder=folder) for each in (seed, seed + 100)]

    return {"function": swing_of_both, "runs": runs}


def swing_of_both(_case: object, results: Sequence[Results]) -> float:
    return sum(float(run["plant.T_gear"].max()) for run in results)


def last_speed(_case: object, results: Sequence[Results]) -> float:
    return float(results[0]["plant.v"][-1])


@pytest.mark.slow
def test_the_answers_are_those_of_single_runs(both_built, lanes, in_lanes, monkeypatch):
    plants = ("TwoMassDriveline", "TwoMassDriveline", "ValidationVehicle")
    cases = [(plants[k % 3], k) for k in range(16)]
    found = run_many(**swing(both_built), cases=cases, workers=1)
    assert sum(in_lanes) == 32
    monkeypatch.setattr(many_runs, "lanes_here", lambda: 0)
    assert found == pytest.approx(run_many(**swing(both_built), cases=cases, workers=1), abs=1e-6)
    assert sum(in_lanes) == 32


@pytest.mark.slow
def test_libraries_with_other_constants_in_the_cache_are_made_again(both_built, lanes, in_lanes, monkeypatch, tmp_path):
    cases = [("TwoMassDriveline", k) for k in range(4)]
    _library.cache_clear()
    found = run_many(**swing(both_built), cases=cases, workers=1)
    there = copytree(tmp_path, tmp_path / "other")
    libraries = {path: path.read_bytes() for path in there.glob("*/lanes/*/*.so")}
    assert len(libraries) == 4
    for path, content in libraries.items():
        numbers = np.frombuffer(content[: len(content) // 8 * 8]).copy()
        constants = (np.abs(numbers) > 1e-6) & (np.abs(numbers) < 1e6)
        assert constants.sum() > 20
        numbers[constants] *= 1.001
        path.write_bytes(numbers.tobytes() + content[len(content) // 8 * 8 :])
    monkeypatch.setenv("XDG_CACHE_HOME", str(there))
    _library.cache_clear()
    assert run_many(**swing(both_built), cases=cases, workers=1) == found
    _library.cache_clear()
    assert sum(in_lanes) == 16
    assert {path: path.read_bytes() for path in libraries} == libraries


def test_few_cases_and_other_blocks_go_alone(both_built, built, lanes, in_lanes):
    run_many(**swing(both_built), cases=[("TwoMassDriveline", k) for k in range(3)], workers=1)
    assert in_lanes == []
    run_many(
        **swing(both_built), cases=[("TwoMassDriveline", 0)], workers=1, known={}
    )  # a campaign may go on with more
    assert in_lanes == [2]
    in_lanes.clear()
    run_many(**swing(built), cases=[("TwoMassDriveline", k) for k in range(4)], workers=1)
    assert in_lanes == []


def test_without_a_compiler_they_go_alone_and_the_log_says_why(both_built, lanes, in_lanes, monkeypatch, caplog):
    monkeypatch.setenv("CC", "no-such-compiler")
    _library.cache_clear()
    with caplog.at_level("INFO"):
        found = run_many(**swing(both_built), cases=[("TwoMassDriveline", k) for k in range(4)], workers=1)
    _library.cache_clear()
    assert in_lanes == []
    plan = swing(both_built)["runs"]
    single = [[each.results() for each in plan(("TwoMassDriveline", k))] for k in range(4)]
    assert found == [swing_of_both(None, results) for results in single]
    assert "its runs are made one after the other, as there is no library for lanes: " in caplog.text
    assert "no-such-compiler" in caplog.text


@pytest.mark.slow
def test_a_run_that_changes_a_parameter_is_that_of_a_single_run(both_built, lanes):
    def changing(time: float) -> list[RunRequest]:
        parameters = {"controller.k_d": 2.0, f"controller.k_d@{time:g}": 0.0}
        return [planned(TIPIN, parameters=parameters, folder=both_built)]

    times = [0.02, 0.06, 0.1, 0.14]
    found = run_many(last_speed, times, workers=1, runs=changing)
    assert found == [last_speed(time, [changing(time)[0].results()]) for time in times]
    assert len(set(found)) == len(times)


def test_a_stream_goes_in_lanes_if_its_batches_are_large(both_built, lanes, in_lanes):
    cases = [("TwoMassDriveline", k) for k in range(5)]
    with many(**swing(both_built), workers=1, batch=3) as answers:
        few = list(answers(iter(cases)))
    assert in_lanes == []
    with many(**swing(both_built), workers=1, batch=4) as answers:
        assert list(answers(iter(cases))) == pytest.approx(few, abs=1e-6)
    assert sum(in_lanes) == 10


@pytest.mark.slow
def test_the_bits_do_not_depend_on_workers_nor_on_what_is_known(both_built, lanes):
    cases = [(("TwoMassDriveline", "ValidationVehicle")[k % 3 == 0], k) for k in range(7)]
    found = run_many(**swing(both_built), cases=cases, workers=1)
    assert found == run_many(**swing(both_built), cases=cases, workers=2)
    assert found == run_many(
        **swing(both_built), cases=cases, workers=1, known=dict(zip(cases[:5], found[:5], strict=True))
    )


def test_a_function_without_a_plan_makes_its_runs_one_by_one(both_built, lanes, in_lanes):
    run_many(lambda seed: simulate(TIPIN, seed=seed, folder=both_built) is None, range(4), workers=1)
    assert in_lanes == []


def test_groups_fill_the_lanes_whatever_the_order_of_the_cases(both_built, lanes, in_lanes):
    count = lanes_here()
    plants = ("TwoMassDriveline", "ValidationVehicle")
    cases = [(plants[k % 2], k) for k in range(count)]  # two runs each
    run_many(**swing(both_built), cases=cases, workers=1, batch=count)
    assert in_lanes == [count, count]


@pytest.mark.parametrize("cases", [3, 4])
def test_a_run_that_cases_share_is_made_once_in_lanes(both_built, lanes, in_lanes, cases):
    finished: list[Results] = []

    def finish(make: Callable[[], Results]) -> Results:
        finished.append(make())
        return finished[-1]

    alone = planned(TIPIN, folder=both_built)
    shared = RunRequest(alone.system, alone.experiment, finish)
    speeds = run_many(last_speed, range(cases), workers=1, runs=lambda _: [shared])
    assert len(set(speeds)) == 1
    assert len(finished) == (1 if cases == 4 else 3)
    assert in_lanes == ([1] if cases == 4 else [])


@pytest.mark.parametrize("cases", [3, 4])
def test_a_judge_gets_the_error_of_a_run_where_it_takes_its_results(both_built, lanes, cases):
    def refused(_: int) -> list[RunRequest]:
        return [planned(TIPIN, folder=both_built, parameters={"controller.k_d": k_d}) for k_d in (1.0, -1.0)]

    def judge(case: int, results: Sequence[Results]) -> tuple[int, str]:
        with pytest.raises(SimulationError) as error:
            results[1]
        return len(results[0]), str(error.value)

    for samples, reason in run_many(judge, range(cases), workers=1, runs=refused):
        assert samples == 201
        assert "k_d = -1.0" in reason
    with pytest.raises(SimulationError, match=r"^case 0: .*k_d = -1\.0"):
        run_many(lambda _, results: len([*results]), range(cases), workers=1, runs=refused)


def test_an_interruption_ends_all_runs(both_built, lanes, monkeypatch):
    monkeypatch.setattr(campaign.LaneLoop, "run", Mock(side_effect=KeyboardInterrupt))
    with pytest.raises(KeyboardInterrupt):
        run_many(**swing(both_built), cases=[("TwoMassDriveline", k) for k in range(4)], workers=1)


def test_runs_that_are_alike_begin_with_what_is_known_of_the_first(both_built, lanes, monkeypatch):
    known: list[bool] = []
    begin = Loop.begin

    def noted(self, experiment, alike=None):
        known.append(alike is not None)
        return begin(self, experiment, alike)

    monkeypatch.setattr(Loop, "begin", noted)
    run_many(last_speed, range(4), workers=1, runs=lambda seed: [planned(TIPIN, seed=seed, folder=both_built)])
    assert known == [False, True, True, True]


def test_the_first_case_with_an_error_is_named(both_built, lanes):
    def bad(case: int) -> list[RunRequest]:
        k_d = {5: -1.0, 6: -2.0}.get(case, 1.0)
        parameters = {"controller.k_d": k_d} | ({"plant.nonsense": 1.0} if case == 7 else {})
        return [planned(TIPIN, folder=both_built, parameters=parameters)]

    known: dict[int, float] = {}
    with pytest.raises(SimulationError, match=r"^case 5: .*k_d = -1\.0"):
        run_many(last_speed, range(8), workers=1, known=known, runs=bad)
    assert list(known) == [0, 1, 2, 3, 4]
    with pytest.raises(WiringError, match=r"^case 7: .*nonsense"):
        run_many(last_speed, [0, 1, 2, 7], workers=1, runs=bad)


@pytest.mark.slow
def test_a_case_that_ends_its_process_is_named(lanes):
    def crash(case: int, _results: Sequence[Results]) -> int:
        return os._exit(3) if case == 6 else case

    known: dict[int, int] = {}
    with pytest.raises(SimulationError, match=r"a process crashed in case 6, and again"):
        run_many(crash, range(16), workers=2, known=known, runs=lambda _: [])
    assert list(known) == list(range(6))
