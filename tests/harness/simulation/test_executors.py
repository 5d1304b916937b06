"""Many runs on a Dask cluster: the same answers as here, and a worker that is lost takes no answer with it."""

import asyncio
import os
import signal
import socket
import sys
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import pytest

from driveline.fmus.catalogue import SIGNAL_FAULTS as FMU
from driveline.harness.design.search.cost_evaluation import CostEvaluation
from driveline.harness.design.search.search_space import space
from driveline.harness.design.search.tune import tune
from driveline.harness.design.search.tuning_runs import Run
from driveline.harness.design.uncertainty_box import NOMINAL
from driveline.harness.loop.resolved import as_given
from driveline.harness.loop.settings import Settings
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.case_archive import CaseArchive, Table
from driveline.harness.simulation.simulate import simulate
from driveline.harness.studies.faults.fault_campaign import campaign
from driveline.harness.studies.faults.fault_injection import FaultRunner
from fmuloop.errors import SimulationError
from fmuloop.executors import dask_executor
from fmuloop.many_runs import many, run_many
from fmuloop.runs import KeptLoops
from toolground.errors import MissingExtra, UserError

dask = pytest.importorskip("dask")
distributed = pytest.importorskip("distributed")


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    """Two workers on this machine, each a process; one that ends is begun again."""
    folder = str(tmp_path_factory.mktemp("workers"))
    given = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None, "local_directory": folder}
    patience = {"distributed.deploy.lost-worker-timeout": "10 minutes"}  # else what is lost twice is given up
    with dask.config.set(patience), distributed.LocalCluster(**given) as made:
        yield made


def answers(function, cases, cluster):
    with dask_executor(cluster.scheduler_address) as executor, many(function, executor=executor) as answered:
        return list(answered(cases))


@pytest.mark.slow
def test_a_worker_that_is_lost_takes_no_answer_with_it(cluster, tmp_path):
    from fmuloop.executors import MOST_UNDER_WAY

    def run(case):
        with (tmp_path / f"{case}").open("a") as file:
            file.write(f"{os.getpid()} ")
        time.sleep(0.01)
        return case, os.getpid()

    def times(case):
        return len((tmp_path / f"{case}").read_text().split())

    with dask_executor(cluster.scheduler_address) as executor, many(run, executor=executor) as answered:
        found = answered(range(300))
        first = [next(found) for _ in range(200)]
        os.kill(first[-1][1], signal.SIGKILL)
        rest = list(found)
    assert [case for case, _ in first + rest] == list(range(300))
    again = sum(times(case) for case in range(300)) - 300
    assert again <= MOST_UNDER_WAY  # and not the hundred that the lost one had answered


def test_a_worker_that_is_lost_leaves_an_archive_with_each_case_once(cluster, tmp_path):
    def run(case):
        with (tmp_path / f"{case}").open("a") as file:
            file.write("x")
        if case == 30 and (tmp_path / "30").stat().st_size == 1:
            os.kill(os.getpid(), signal.SIGKILL)
        return -case

    table = Table(["case", "answer"], lambda *row: row, lambda cells: (int(cells[0]), int(cells[1])))
    archive = CaseArchive(tmp_path / "archive.csv", table)
    with dask_executor(cluster.scheduler_address) as executor:
        found = run_many(run, range(60), executor=executor, known=archive, batch=4)
    assert found == [-case for case in range(60)]
    lines = (tmp_path / "archive.csv").read_text().split()
    assert lines == ["case,answer", *(f"{case},{-case}" for case in range(60))]


def test_runs_on_a_cluster_are_those_here_and_stay_loaded(cluster, native):
    brief = replace(MANOEUVRES["tipin15"], duration=1.1)

    def end(k_d):
        settings = {"folder": native.parent, "build": "native"}
        return simulate(brief, parameters={"controller.k_d": k_d}, **settings)[-1].tolist()

    cases = [0.0, 1.0, 2.0, 3.0]
    assert answers(end, cases, cluster) == [end(case) for case in cases]


@pytest.mark.slow
def test_faults_and_search_on_a_cluster_are_those_here(cluster, native, native_builder, tmp_path):
    settings = Settings(folder=native.parent, build="native")
    faults = FaultRunner(native_builder(FMU, tmp_path), {"TwoMassDriveline": as_given(settings)})
    search = CostEvaluation(settings, runs=(Run("TwoMassDriveline", "tipin15", NOMINAL, 1, 1.0),))

    def searched(name, **where):
        return tune(search, space("DampingController", {}), 3, 1, tmp_path / name, **where)

    with dask_executor(cluster.scheduler_address) as executor:
        assert campaign(faults, [1, 2], 1, executor=executor) == campaign(faults, [1, 2], 1, workers=1)
        assert searched("there", executor=executor) == searched("here", workers=1)


def test_a_notebook_has_an_event_loop_of_its_own(cluster):
    async def cell():
        return answers(abs, [-1, -2], cluster)

    assert asyncio.run(cell()) == [1, 2]


def test_what_goes_wrong_on_a_worker_names_its_case(cluster):
    def fails(case):
        if case >= 2:
            raise UserError(f"no {case}")
        return case

    with dask_executor(cluster.scheduler_address) as executor, many(fails, executor=executor) as answered:
        found = answered(range(5))
        assert [next(found), next(found)] == [0, 1]
        with pytest.raises(UserError, match="case 2: no 2"):
            next(found)


def test_what_is_warned_of_on_a_worker_is_told_here(cluster, caplog):
    def warns(case):
        import logging

        logging.getLogger("fmuloop.somewhere").warning("case %s is odd", case)

    answers(warns, ["of the cluster"], cluster)
    logged = [record.getMessage() for record in caplog.records if record.name == "toolground"]
    assert logged == ["case of the cluster is odd"]


@pytest.mark.slow
def test_a_case_that_ends_its_workers_is_named(cluster, monkeypatch):
    monkeypatch.setattr(cluster.scheduler, "allowed_failures", 0)

    def ends(case):
        os.kill(os.getpid(), signal.SIGKILL)

    with pytest.raises(SimulationError, match="a process crashed in case 'a bad one'"):
        answers(ends, ["'a bad one'"], cluster)


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:1", "nonsense", "foo://here:80", ""])
def test_no_scheduler_is_one_line(address, monkeypatch):
    monkeypatch.setattr("fmuloop.executors.TIMEOUT", 0.3)
    with pytest.raises(UserError, match=f"^no Dask scheduler answers at '{address}'(: | within 0.3 s$)"):
        dask_executor(address).__enter__()


def test_what_takes_the_connection_and_says_nothing_is_no_scheduler(monkeypatch):
    monkeypatch.setattr("fmuloop.executors.TIMEOUT", 0.3)
    with socket.create_server(("127.0.0.1", 0)) as silent:
        address = f"tcp://127.0.0.1:{silent.getsockname()[1]}"
        with pytest.raises(UserError, match=f"^no Dask scheduler answers at '{address}' within 0.3 s$"):
            dask_executor(address).__enter__()


def test_without_the_package_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(MissingExtra, match=r"the extra `cluster`.*fmuloop\[cluster\]"):
        dask_executor("tcp://127.0.0.1:1").__enter__()


@pytest.mark.slow
def test_loops_that_are_closed_are_loaded_again(native, tmp_path):
    from driveline.harness.loop.settings import loop

    loops, system = KeptLoops(tmp_path), loop(folder=native.parent, build="native")
    first = loops.loop(system, (), ())
    assert loops.loop(system, (), ()) is first
    loops.close()
    assert not any(Path(tmp_path).iterdir())
    assert loops.loop(system, (), ()) is not first
    loops.close()


@pytest.mark.parametrize("kind", [ThreadPoolExecutor, ProcessPoolExecutor])
def test_the_executors_of_the_standard_library_share_cases(kind):
    with kind(2) as executor:
        assert run_many(abs, range(-40, 0), executor=executor, batch=3) == list(range(40, 0, -1))
