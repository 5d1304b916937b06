"""Interpreters that run a function are held to their limits, and leave nothing behind."""

import math
import os
import signal
import sys
import tempfile
from importlib import import_module
from pathlib import Path
from time import sleep
from typing import Any

import pytest

from tests.toolground.test_child_process import gone, wait_until
from toolground import interpreter as interpreter_module
from toolground.child_process import run
from toolground.interpreter import ChildError, Interpreter, Limits, call

AMPLE = Limits(wall=60.0, computing=30, memory=10**9)

ONLY_LINUX = pytest.mark.skipif(sys.platform != "linux", reason="only Linux limits the memory of a process")


def test_a_function_is_called_with_its_own_temporary_folder_which_vanishes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    folder = Path(call(tempfile.gettempdir, limits=AMPLE))
    assert folder.parent == tmp_path
    assert list(tmp_path.iterdir()) == []
    assert call(os.getenv, "ASKED", limits=AMPLE, environment={"ASKED": "so"}) == "so"


@pytest.mark.parametrize(
    ("call_of", "limits", "message"),
    [
        ((sleep, 60.0), AMPLE._replace(wall=0.3), "^takes more than 0.3 s$"),
        ((sum, range(10**12)), AMPLE._replace(computing=1), "^takes more than 1 s$"),
    ],
)
def test_a_function_that_takes_longer_is_ended(call_of: Any, limits: Limits, message: str) -> None:
    with pytest.raises(TimeoutError, match=message):
        call(*call_of, limits=limits)


def test_without_limits_of_the_system_a_function_has_as_long_as_it_may_compute(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "resource.py").write_text("raise ImportError")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(interpreter_module, "resource", None)
    assert call(abs, -3, limits=AMPLE) == 3
    with pytest.raises(TimeoutError, match=r"^takes more than 1 s$"):
        call(sleep, 60.0, limits=AMPLE._replace(computing=1))


@ONLY_LINUX
def test_a_function_has_so_much_memory() -> None:
    limits = AMPLE._replace(memory=200_000_000)
    assert len(call(bytes, 150_000_000, limits=limits)) == 150_000_000
    with pytest.raises(ChildError, match=r"^MemoryError$"):
        call(bytes, 200_000_000, limits=limits)


def test_a_function_that_ends_its_process_is_told_by_its_last_line_or_exit_code() -> None:
    with pytest.raises(ChildError, match=r"^ValueError: math domain error$"):
        call(math.sqrt, -1.0, limits=AMPLE)
    with pytest.raises(ChildError, match=f"^exit code {-signal.SIGKILL}$"):
        call(signal.raise_signal, signal.SIGKILL, limits=AMPLE)


HOST = """
import os, sys
def echo(questions, answers):
    print("printed")
    while question := questions.read(3):
        answers.write(question if question != b"pid" else b"%7d" % os.getpid())
        answers.flush()
        if question == b"end":
            os._exit(7)
"""


@pytest.fixture
def interpreter(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    (tmp_path / "echoing.py").write_text(HOST)
    monkeypatch.syspath_prepend(tmp_path)
    running = Interpreter(import_module("echoing").echo, tmp_path)
    yield running
    running.end()


def test_what_is_printed_is_no_answer_and_what_comes_late_is_there_for_the_next_reading(
    interpreter: Interpreter,
) -> None:
    interpreter.send(b"abc")
    assert interpreter.read(2) == b"ab"
    with pytest.raises(TimeoutError):
        interpreter.read(3, within=0.2)
    interpreter.send(b"def")
    assert interpreter.read(4, within=60.0) == b"cdef"
    assert interpreter.end(patience=60.0), "nothing more is sent, so it ends by itself"
    assert not interpreter.folder.exists()
    assert interpreter.end()


def test_what_was_written_before_the_end_is_read_and_nothing_is_waited_for(interpreter: Interpreter) -> None:
    interpreter.send(b"end")
    assert interpreter.read(3) == b"end"
    with pytest.raises(EOFError):
        interpreter.read(1)
    interpreter.send(bytes(10**6))  # goes nowhere
    interpreter.process.wait(60.0)
    assert interpreter.end()
    assert interpreter.process.returncode == 7


ORPHANED = """
import os, signal
from importlib import import_module
from toolground.interpreter import Interpreter
running = Interpreter(import_module("echoing").echo)
running.send(b"pid")
print(running.read(7).decode(), running.folder, flush=True)
os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.mark.slow
def test_an_interpreter_and_its_folder_vanish_with_a_process_that_is_killed(
    interpreter: Interpreter, tmp_path: Path
) -> None:
    environment = {"PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path])}
    done = run([sys.executable, "-c", ORPHANED], environment=environment)
    number, folder = done.stdout.split()
    wait_until(lambda: gone(int(number)))
    wait_until(lambda: not Path(folder).exists())
