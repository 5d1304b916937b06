"""Many runs in several processes: the same answers, in order; what fails names its case; nothing stays behind."""

import os
import signal
import subprocess
import sys
import time
import weakref
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Lock

import pytest
from fmutesting.slow import slow

from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import simulate
from fmuloop.errors import SimulationError
from fmuloop.many_runs import many, run_many
from fmuloop.system import Scheme
from tests import ROOT
from toolground.atomic_files import complete
from toolground.collected_warnings import warn_once
from toolground.errors import UserError

TIPIN = replace(MANOEUVRES["tipin15"], duration=0.1)

CASES = [
    (plant, build, k_d)
    for k_d in (0.0, 2.0)
    for plant in ("TwoMassDriveline", "ValidationVehicle")
    for build in ("native", "python")
]


THREADS = """
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from fmuloop.many_runs import run_many
from driveline.harness.simulation.simulate import simulate


def end(k_d):
    tip_in = replace(MANOEUVRES["tipin15"], duration=0.5)
    return simulate(tip_in, parameters={{"controller.k_d": k_d}}, folder=Path({0!r}))[-1].tolist()


cases = [0.0, 1.0, 2.0]
alone = [end(case) for case in cases]
with ThreadPoolExecutor(3) as threads:
    assert list(threads.map(lambda _: run_many(end, cases, workers=1), range(6))) == [alone] * 6
"""
"""Two threads that step the same instances end their process, so they get one of their own."""


def in_folder(fmus):
    """Gives the end of a tip-in for a plant, a build and a gain."""

    def tip_in(case):
        plant, build, k_d = case
        settings = {"controller.k_d": k_d}
        # under Jacobi both builds do the same, to the last bit
        return simulate(TIPIN, plant, parameters=settings, scheme=Scheme.JACOBI, folder=fmus, build=build)[-1].tolist()

    return tip_in


@pytest.mark.slow
def test_answers_do_not_depend_on_the_workers_nor_on_the_order(both_built, unpacked):
    tip_in = in_folder(both_built)
    here = run_many(tip_in, CASES, workers=1)
    assert here == [tip_in(case) for case in CASES]
    assert len(set(map(tuple, here))) == len(CASES) / 2
    assert run_many(tip_in, CASES, workers=2) == here
    assert run_many(tip_in, CASES[::-1], workers=3) == here[::-1]
    assert list(unpacked.iterdir()) == []


def process(_case):
    return os.getpid()


def test_one_worker_is_this_process_and_others_share_the_cases():
    assert run_many(process, range(3), workers=1) == 3 * [os.getpid()]
    assert run_many(process, range(1)) == [os.getpid()]
    others = run_many(lambda case: (os.environ["OPENBLAS_NUM_THREADS"], process(case)), range(3), workers=2)
    assert os.getpid() not in [number for _, number in others]
    assert {threads for threads, _ in others} == {"1"}, "cores are not shared twice"
    assert run_many(process, []) == []


def test_progress_is_told_of_every_case(monkeypatch):
    told = []

    @contextmanager
    def progress(total, label):
        told.append((total, label))
        yield told.append

    monkeypatch.setattr("fmuloop.many_runs.progress", progress)
    run_many(abs, [-1, -2, -3], workers=1, label="counting")
    assert told == [(3, "counting"), 0, 1, 2, 3]


def test_threads_do_not_share_what_is_kept_loaded(native, tmp_path):
    script = tmp_path / "threads.py"
    script.write_text(THREADS.format(str(native.parent)), encoding="utf-8")
    done = subprocess.run([sys.executable, script], cwd=ROOT, env=os.environ | {"PYTHONPATH": str(ROOT)}, check=False)
    assert done.returncode == 0


@pytest.mark.parametrize("workers", [1, 2])
def test_a_refusal_names_its_case(native, workers, unpacked):
    cases = [("TwoMassDriveline", "native", k_d) for k_d in (1.0, -1.0, 2.0, -2.0)]
    with pytest.raises(SimulationError, match=r"^case \('TwoMassDriveline', 'native', -1\.0\): controller .* k_d = -1"):
        run_many(in_folder(native.parent), cases, workers)
    assert list(unpacked.iterdir()) == []


@pytest.mark.parametrize("workers", [1, 2])
def test_any_other_error_keeps_its_type_and_gets_a_note(workers):
    with pytest.raises(ZeroDivisionError) as error:
        run_many(lambda case: 1 / case, [2, 1, 0], workers)
    assert error.value.__notes__ == ["in case 0"]


class Foreign(Exception):
    """Cannot be made of its message, as pickle does."""

    def __init__(self, name, number):
        super().__init__(f"{name} refused {number}")


def foreign(case):
    if case == "foreign":
        raise Foreign("pump", 7)
    if case == "exit":
        sys.exit(0)
    raise StopIteration(3)


@pytest.mark.parametrize(
    ("case", "expected"),
    [("foreign", "Foreign: pump refused 7"), ("exit", "SystemExit: 0"), ("stop", "StopIteration: 3")],
)
@pytest.mark.parametrize("workers", [1, 2])
def test_an_error_that_cannot_travel_is_named_with_its_case(case, expected, workers):
    if (case, workers) == ("foreign", 1):
        pytest.skip("it need not travel")
    with pytest.raises(SimulationError, match=f"^case {case}: {expected}$"):
        run_many(foreign, [case, "other"], workers)


def unreadable():
    raise ValueError("made of nothing")


class Unreadable:
    """Is sent, and cannot be made again."""

    def __reduce__(self):
        return unreadable, ()


def untransportable(case):
    return {2: Lock(), 3: Unreadable()}.get(case, case)


@pytest.mark.parametrize("batch", [1, 3])
@pytest.mark.parametrize(
    ("cases", "expected"),
    [
        ([0, 1, 2, 3], r"case 2: its answer, a lock, cannot be sent to another process: TypeError: cannot pickle .*"),
        ([0, 1, 3, 2], "case 3: its answer cannot be read from its worker: ValueError: made of nothing"),
    ],
)
def test_an_answer_that_cannot_travel_is_named_with_its_case(cases, expected, batch):
    known = {}
    with pytest.raises(SimulationError, match=f"^{expected}$"):
        run_many(untransportable, cases, workers=2, known=known, batch=batch)
    assert known == {0: 0, 1: 1}


def test_a_long_case_is_shortened():
    with pytest.raises(ValueError, match="could not convert") as error:
        run_many(float, ["word " * 1000], workers=1)
    (note,) = error.value.__notes__
    assert note.startswith("in case word word")
    assert len(note) < 220


@pytest.mark.slow
def test_a_crash_is_told(native, unpacked):
    def crash(case):
        in_folder(native.parent)(CASES[0])
        return os._exit(3) if case == 1 else case

    with pytest.raises(SimulationError, match=r"^a process crashed in case 1, and again when that was run once more$"):
        run_many(crash, range(4), workers=2)
    assert list(unpacked.iterdir()) == []


@pytest.mark.parametrize("at", slow([0, 7, 19], but=[7]))
def test_a_case_whose_process_was_lost_is_run_once_more_and_all_are_answered(tmp_path, at):
    def run(case):
        with (tmp_path / f"{case}").open("a") as file:
            file.write("x")
        if case == at and (tmp_path / f"{case}").stat().st_size == 1:
            os.kill(os.getpid(), signal.SIGKILL)
        return -case

    with many(run, workers=2) as answered:
        assert list(answered(range(20))) == [-case for case in range(20)]
        assert list(answered([20, 21])) == [-20, -21]  # those that came instead are as good
    times = [(tmp_path / f"{case}").stat().st_size for case in range(22)]
    assert times[at] == max(times) == 2


def test_what_is_known_is_not_asked_again_and_what_is_answered_is_known():
    asked, known = [], {3: "known", 9: "of no use here"}

    def ask(case):
        asked.append(case)
        return str(case)

    assert run_many(ask, [2, 3, 4, 2], workers=1, known=known) == ["2", "known", "4", "2"]
    assert asked == [2, 4]
    assert known == {3: "known", 9: "of no use here", 2: "2", 4: "4"}


@pytest.mark.parametrize(("workers", "batch", "most"), [(1, 1, 0), (2, 1, 8), (2, 3, 24)])
def test_cases_are_taken_a_few_ahead_of_the_answers(workers, batch, most):
    taken = []

    def cases():
        for case in range(100):
            taken.append(case)
            yield case

    with many(str, workers=workers, batch=batch) as answered:
        for number, answer in enumerate(answered(cases())):
            assert answer == str(number)
            assert len(taken) <= number + 1 + most


@pytest.mark.parametrize("workers", [1, 2])
def test_answers_that_nobody_keeps_are_gone(workers):
    alive = weakref.WeakSet()
    with many(replaced, workers=workers) as answered:
        for answer in answered(range(60)):
            alive.add(answer)
            assert len(alive) <= 10, "those that are under way, and this one and the one before"


def replaced(duration):
    return replace(TIPIN, duration=duration)


@pytest.mark.parametrize("workers", [1, 2])
def test_an_error_in_a_batch_comes_after_the_answers_before_it(workers):
    known = {}
    with pytest.raises(ZeroDivisionError) as error:
        run_many(lambda case: 6 // case, [3, 2, 1, 0, 6], workers, known=known, batch=5)
    assert error.value.__notes__ == ["in case 0"]
    assert known == {3: 2, 2: 3, 1: 6}


@pytest.mark.slow
@pytest.mark.parametrize("batch", [1, 4])
def test_what_comes_before_a_case_that_ends_its_process_twice_is_answered(tmp_path, batch):
    def run(case):
        with (tmp_path / f"{case}").open("a") as file:
            file.write("x")
        return os._exit(3) if case == 5 else case

    known = {}
    with pytest.raises(SimulationError, match="a process crashed in case 5, and again"):
        run_many(run, range(12), workers=2, known=known, batch=batch)
    assert known == {case: case for case in range(5)}
    assert batch > 1 or (tmp_path / "5").stat().st_size == 2


def test_a_process_that_ends_beside_an_error_is_not_that_of_the_case_with_the_error(tmp_path):
    """The first batch raises when the second has ended its process, so what is left of it finds that no process is
    left."""

    def run(case):
        if case == 1:
            while not (tmp_path / "ended").exists():
                time.sleep(0.01)
            return 1 / 0
        if case == 3:
            (tmp_path / "ended").touch()
            os._exit(3)
        return case

    with pytest.raises(ZeroDivisionError) as error:
        run_many(run, range(4), workers=2, batch=2)
    assert error.value.__notes__ == ["in case 1"]


@pytest.mark.parametrize("batch", [0, 1.5])
def test_a_size_of_batches_that_is_none_is_refused(batch):
    with pytest.raises(UserError, match="batch = "):
        run_many(str, [1], batch=batch)


SCRIPT = """
import sys, tempfile
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Lock
from fmuloop.many_runs import run_many
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import simulate

def end(seed):
    return simulate(MANOEUVRES["tipin15"], seed=seed, folder=Path({folder!r}), step_size=0.002)["plant.v"][-1]

one, other = run_many(end, [1, 2], workers=2), run_many(end, [1, 2], workers=1)
print(one == other, "fmuloop.workers" in sys.modules, *Path(tempfile.gettempdir()).iterdir())
"""


@pytest.mark.parametrize("how", ["script", "stdin"])
def test_no_guard_is_needed(native, tmp_path, how):
    """Neither in a script nor where there is no file at all, as in an interactive session."""
    text = SCRIPT.format(folder=str(native.parent))
    script, temporary = tmp_path / "script.py", tmp_path / "temporary"
    script.write_text(text)
    temporary.mkdir()
    done = subprocess.run(
        [sys.executable, "-" if how == "stdin" else str(script)],
        input=text if how == "stdin" else None,
        env=os.environ | {"PYTHONPATH": str(ROOT), "TMPDIR": str(temporary)},
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stdout.split(), done.stderr) == (0, ["True", "True"], "")


@pytest.mark.parametrize("workers", [0, -1, 1.5])
def test_a_number_of_workers_that_is_none_is_refused(workers):
    with pytest.raises(UserError, match="workers = "):
        run_many(str, [1], workers=workers)


def test_what_a_killed_worker_was_writing_goes_and_nothing_else(tmp_path):
    def write(case):
        if case == 0:
            while not list(tmp_path.glob("signals.csv.*.part")):
                time.sleep(0.01)
            raise ValueError("this case fails while the other one writes")
        with complete(tmp_path / "signals.csv") as unfinished:
            unfinished.write_text("time")
            time.sleep(60.0)

    others = tmp_path / "theirs.123.part"
    others.touch()
    with pytest.raises(ValueError, match="this case fails"):
        run_many(write, range(2), workers=2)
    assert list(tmp_path.iterdir()) == [others]


def test_what_a_killed_worker_has_in_temporary_folders_goes(tmp_path):
    """As the files of a compiler that it had begun."""
    found = tmp_path / "found"

    def compile_long(case):
        if case == 0:
            while not found.exists():
                time.sleep(0.01)
            raise ValueError("this case fails while the other one compiles")
        with TemporaryDirectory() as folder:
            with complete(found) as unfinished:
                unfinished.write_text(folder)
            time.sleep(60.0)

    with pytest.raises(ValueError, match="this case fails"):
        run_many(compile_long, range(2), workers=2)
    assert not Path(found.read_text()).exists()


ORPHANED = """
import os
import signal
from time import sleep

from fmuloop.many_runs import run_many


def case(number):
    if number == 1:
        os.kill(os.getppid(), signal.SIGKILL)
    sleep(0.1)


run_many(case, range(4), workers=2)
"""


@pytest.mark.slow
def test_workers_end_when_the_process_that_waits_is_killed(tmp_path):
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "TMPDIR": str(tmp_path)}
    command = [sys.executable, "-c", ORPHANED]
    # waits for the end of what the workers have too, and so for theirs
    done = subprocess.run(command, cwd=tmp_path, env=environment, stderr=subprocess.PIPE, timeout=30, check=False)
    assert done.returncode == -signal.SIGKILL
    assert not list(tmp_path.glob("*-*"))


def warned(case):
    warn_once(f"this is said of all runs, also of {min(case, 1)}")


@pytest.mark.parametrize("workers", [1, 2])
def test_what_several_workers_warn_of_is_logged_once(workers, caplog):
    warn_once.cache_clear()
    run_many(warned, range(6), workers=workers)
    assert sorted(caplog.messages) == [f"this is said of all runs, also of {k}" for k in (0, 1)]
