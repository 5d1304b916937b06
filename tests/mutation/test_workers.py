"""The tests of a fault end, and so does all that they have started."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

MUTATION = Path(__file__).parent

pytestmark = pytest.mark.slow  # imports what all tests of all faults need


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


def test_what_a_test_has_started_does_not_go_on_without_it(tmp_path: Path) -> None:
    sleeper = '[sys.executable, "-c", "import time; time.sleep(100)"]'
    test = f'open("started", "w").write(str(subprocess.Popen({sleeper}, start_new_session=True).pid))'
    assert answered('workers.failing(["test_it.py"])', test, tmp_path) == "None"
    with pytest.raises(ProcessLookupError):
        os.kill(int((tmp_path / "started").read_text()), 0)


def test_a_test_that_waits_for_ever_has_failed(tmp_path: Path) -> None:
    assert answered('workers.failing(["test_it.py"])', "threading.Event().wait()", tmp_path) == "test_it.py::test_it"


def test_a_test_that_fails_without_the_fault_does_not_find_it(tmp_path: Path) -> None:
    (tmp_path / "code.py").write_text("x = 1.0\n")
    call = 'workers.finder(Mutant("code.py", 1, 4, "x = 1.0", "1.0", "1.2"), [["test_it.py"]], [])'
    assert answered(call, "assert False", tmp_path) == "None"
