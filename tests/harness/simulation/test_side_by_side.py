"""Cases side by side: one function at work at a time, and the answers of single runs."""

import os
import signal
import threading
import time
from dataclasses import replace
from pathlib import Path
from shutil import copytree
from unittest.mock import Mock

import numpy as np
import pytest

from driveline.harness.loop.lane_libraries import _library
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import simulate
from fmuloop import many_runs, side_by_side
from fmuloop.errors import SimulationError, WiringError
from fmuloop.many_runs import many, run_many
from fmuloop.master import Loop
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
    run = side_by_side.LaneLoop.run

    def counted(self, loop, experiments):
        counts.append(len(experiments))
        return run(self, loop, experiments)

    monkeypatch.setattr(side_by_side.LaneLoop, "run", counted)
    return counts


def swing(folder: Path):
    def of(case: tuple[str, int]) -> float:
        plant, seed = case
        first = simulate(TIPIN, plant, seed=seed, folder=folder)["plant.T_gear"].max()
        return first + simulate(TIPIN, plant, seed=seed + 100, folder=folder)["plant.T_gear"].max()

    return of


@pytest.mark.slow
def test_the_answers_are_those_of_single_runs(both_built, lanes, in_lanes, monkeypatch):
    plants = ("TwoMassDriveline", "TwoMassDriveline", "ValidationVehicle")
    cases = [(plants[k % 3], k) for k in range(16)]
    found = run_many(swing(both_built), cases, workers=1)
    assert sum(in_lanes) == 32
    monkeypatch.setattr(many_runs, "lanes_here", lambda: 0)
    assert found == pytest.approx(run_many(swing(both_built), cases, workers=1), abs=1e-6)
    assert sum(in_lanes) == 32


@pytest.mark.slow
def test_libraries_with_other_constants_in_the_cache_are_made_again(both_built, lanes, in_lanes, monkeypatch, tmp_path):
    cases = [("TwoMassDriveline", k) for k in range(4)]
    _library.cache_clear()
    found = run_many(swing(both_built), cases, workers=1)
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
    assert run_many(swing(both_built), cases, workers=1) == found
    _library.cache_clear()
    assert sum(in_lanes) == 16
    assert {path: path.read_bytes() for path in libraries} == libraries


def test_few_cases_and_other_blocks_go_alone(both_built, built, lanes, in_lanes):
    run_many(swing(both_built), [("TwoMassDriveline", k) for k in range(3)], workers=1)
    assert in_lanes == []
    run_many(swing(both_built), [("TwoMassDriveline", 0)], workers=1, known={})  # a campaign may go on with more
    assert len(in_lanes) == 2
    in_lanes.clear()
    run_many(swing(built), [("TwoMassDriveline", k) for k in range(4)], workers=1)
    assert in_lanes == []


def test_without_a_compiler_they_go_alone_and_the_log_says_why(both_built, lanes, in_lanes, monkeypatch, caplog):
    monkeypatch.setenv("CC", "no-such-compiler")
    _library.cache_clear()
    with caplog.at_level("INFO"):
        found = run_many(swing(both_built), [("TwoMassDriveline", k) for k in range(4)], workers=1)
    _library.cache_clear()
    assert in_lanes == []
    assert found == [swing(both_built)(("TwoMassDriveline", k)) for k in range(4)]
    assert "its runs are made one after the other, as there is no library for lanes: " in caplog.text
    assert "no-such-compiler" in caplog.text


@pytest.mark.slow
def test_a_run_that_changes_a_parameter_is_that_of_a_single_run(both_built, lanes):
    def end(time: float) -> float:
        parameters = {"controller.k_d": 2.0, f"controller.k_d@{time:g}": 0.0}
        return float(simulate(TIPIN, parameters=parameters, folder=both_built)["plant.T_gear"][-1])

    times = [0.02, 0.06, 0.1, 0.14]
    found = run_many(end, times, workers=1)
    assert found == [end(time) for time in times]
    assert len(set(found)) == len(times)


def test_a_stream_goes_in_lanes_if_its_batches_are_large(both_built, lanes, in_lanes):
    cases = [("TwoMassDriveline", k) for k in range(5)]
    with many(swing(both_built), workers=1, batch=3) as answers:
        few = list(answers(iter(cases)))
    assert in_lanes == []
    with many(swing(both_built), workers=1, batch=4) as answers:
        assert list(answers(iter(cases))) == pytest.approx(few, abs=1e-6)
    assert sum(in_lanes) == 10


@pytest.mark.slow
def test_the_bits_do_not_depend_on_workers_nor_on_what_is_known(both_built, lanes):
    cases = [(("TwoMassDriveline", "ValidationVehicle")[k % 3 == 0], k) for k in range(7)]
    found = run_many(swing(both_built), cases, workers=1)
    assert found == run_many(swing(both_built), cases, workers=2)
    assert found == run_many(swing(both_built), cases, workers=1, known=dict(zip(cases[:5], found[:5], strict=True)))


def test_one_function_is_at_work_at_a_time(both_built, lanes):
    at_work: list[int] = []

    def alone(case: int) -> int:
        for _ in range(case % 3):
            at_work.append(case)
            time.sleep(0.001)
            assert at_work.pop() == case
            assert not at_work
            simulate(TIPIN, seed=case, folder=both_built)
        return case

    assert run_many(alone, range(9), workers=1) == list(range(9))


def test_threads_are_those_of_the_batch_before_and_end_where_it_is_stopped(both_built, lanes, monkeypatch):
    def ended(case: int) -> int:
        simulate(TIPIN, seed=case, folder=both_built)
        return case

    monkeypatch.setattr(side_by_side, "_idle", [])
    before = {*threading.enumerate()}  # with those of other tests, which stay
    for _ in range(2):
        assert run_many(ended, range(4), workers=1) == list(range(4))
        assert len({*threading.enumerate()} - before) == 4
    monkeypatch.setattr(side_by_side, "_made", Mock(side_effect=KeyboardInterrupt))
    with pytest.raises(KeyboardInterrupt):
        run_many(ended, range(4), workers=1)
    for thread in {*threading.enumerate()} - before:
        thread.join(5.0)
    assert {*threading.enumerate()} <= before


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no forks here")
def test_a_process_that_forks_after_a_batch_answers_the_next(both_built, lanes):
    def ended(case: int) -> int:
        simulate(TIPIN, seed=case, folder=both_built)
        return case

    assert run_many(ended, range(4), workers=1) == list(range(4))
    child = os.fork()
    if child == 0:
        signal.alarm(30)  # ends it where it hangs
        os._exit(run_many(ended, range(4), workers=1) != list(range(4)))
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0


def test_runs_that_are_alike_begin_with_what_is_known_of_the_first(both_built, lanes, monkeypatch):
    known: list[bool] = []
    begin = Loop.begin

    def noted(self, experiment, alike=None):
        known.append(alike is not None)
        return begin(self, experiment, alike)

    monkeypatch.setattr(Loop, "begin", noted)
    run_many(lambda seed: simulate(TIPIN, seed=seed, folder=both_built) is None, range(4), workers=1)
    assert known == [False, True, True, True]


def test_the_first_case_with_an_error_is_named(both_built, lanes):
    def bad(case: int) -> float:
        k_d = {5: -1.0, 6: -2.0}.get(case, 1.0)
        parameters = {"controller.k_d": k_d} | ({"plant.nonsense": 1.0} if case == 7 else {})
        return float(simulate(TIPIN, folder=both_built, parameters=parameters)["plant.v"][-1])

    known: dict[int, float] = {}
    with pytest.raises(SimulationError, match=r"^case 5: .*k_d = -1\.0"):
        run_many(bad, range(8), workers=1, known=known)
    assert list(known) == [0, 1, 2, 3, 4]
    with pytest.raises(WiringError, match=r"^case 7: .*nonsense"):
        run_many(bad, [0, 1, 2, 7], workers=1)


@pytest.mark.slow
def test_a_case_that_ends_its_process_is_named(lanes):
    def crash(case: int) -> int:
        return os._exit(3) if case == 6 else case

    known: dict[int, int] = {}
    with pytest.raises(SimulationError, match=r"a process crashed in case 6, and again"):
        run_many(crash, range(16), workers=2, known=known)
    assert list(known) == list(range(6))
