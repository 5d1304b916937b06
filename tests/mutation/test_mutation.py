"""A sample is what its seed says, a fault leaves the file as it was, and whatever its tests have started ends."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from covering import own, rounds
from mutants import LEAST, Mutant, rooms, shares

MUTATION = Path(__file__).parent

ONE = Mutant("code.py", 1, 4, "x = 1.0", "1.0", "1.2")


@pytest.mark.parametrize("size", [40, 200, 201])
def test_every_room_gets_some_faults_and_the_others_go_by_lines(size: int) -> None:
    lines = {"tiny": 1, "small": 990, "large": 9009}
    found = shares(lines, size)
    assert sum(found.values()) == size
    assert found["tiny"] in (LEAST, LEAST + 1)
    for room in ("small", "large"):
        assert found[room] - LEAST == pytest.approx((size - 3 * LEAST) * lines[room] / 10_000, abs=1.0)


def test_what_is_drawn_depends_on_the_seed_and_not_on_where_a_line_stands() -> None:
    assert ONE.lot(1) == ONE._replace(file="harness/base/code.py", line=9, place=99).lot(1)
    assert ONE.lot(1) != ONE.lot(2)
    assert ONE.lot(1) != ONE._replace(new="0.8").lot(1)


def test_the_tests_of_the_file_itself_are_run_first() -> None:
    for file in [file for files in rooms().values() for file in files][::20]:
        first, *others = rounds(file) or [[]]
        assert not (file.endswith(".py") and own(file)) or first == own(file)
        assert not set(first) & {test for tests in others for test in tests}


def test_a_fault_leaves_the_file_as_it_was(tmp_path: Path) -> None:
    file = tmp_path / "code.py"
    file.write_text("x = 1.0\n", encoding="utf-8")
    before = file.stat().st_mtime_ns
    with ONE.applied(tmp_path):
        assert file.read_text(encoding="utf-8") == "x = 1.2\n"
        assert file.stat().st_mtime_ns != before
    assert (file.read_text(encoding="utf-8"), file.stat().st_mtime_ns) == ("x = 1.0\n", before)


def answered(call: str, test: str, folder: Path) -> str:
    """What a call of the module of workers returns in a folder that has a test."""
    (folder / "temporary").mkdir()
    (folder / "test_it.py").write_text(f"import subprocess, sys, threading\n\ndef test_it():\n    {test}\n")
    prepared = "workers._prctl(workers.PR_SET_CHILD_SUBREAPER, 1); workers.TEST_WAITED = 1"
    code = f"import workers; from mutants import Mutant; {prepared}; print({call})"
    environment = os.environ | {"PYTHONPATH": str(MUTATION)}
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=folder, env=environment, capture_output=True, text=True, timeout=100
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


@pytest.mark.slow
def test_what_a_test_has_started_does_not_go_on_without_it(tmp_path: Path) -> None:
    sleeper = '[sys.executable, "-c", "import time; time.sleep(100)"]'
    test = f'open("started", "w").write(str(subprocess.Popen({sleeper}, start_new_session=True).pid))'
    assert answered('workers.failing(["test_it.py"])', test, tmp_path) == "None"
    with pytest.raises(ProcessLookupError):
        os.kill(int((tmp_path / "started").read_text()), 0)


@pytest.mark.slow
def test_a_test_that_waits_for_ever_has_failed(tmp_path: Path) -> None:
    assert answered('workers.failing(["test_it.py"])', "threading.Event().wait()", tmp_path) == "test_it.py::test_it"


@pytest.mark.slow
def test_a_test_that_fails_without_the_fault_does_not_find_it(tmp_path: Path) -> None:
    (tmp_path / "code.py").write_text("x = 1.0\n")
    assert answered(f'workers.finder({ONE!r}, [["test_it.py"]], [])', "assert False", tmp_path) == "None"
