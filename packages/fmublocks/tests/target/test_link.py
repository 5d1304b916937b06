"""The link: a program that is lost, hangs or crashes is named within a second, and nothing of it is left."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from fmutesting.together import together

from fmublocks.target import link
from fmublocks.target.link import Link, TargetError

PROGRAM = """
import struct, sys, time
received = 0
while command := sys.stdin.buffer.read(1):
    if command == b"i":
        answer = struct.pack("<4I", 8, 4, 4, 4)
    else:
        size = 8 if command in b"su" else 4
        given = struct.unpack(f"<{size // 4}f", sys.stdin.buffer.read(size))
        received += 1
        if received == 3:
            OTHERWISE
        answer = struct.pack("<2f2I", sum(given), received, 100, 64)
    sys.stdout.buffer.write(answer)
    sys.stdout.buffer.flush()
"""
"""Two inputs, one output (their sum), one state; the third command is answered otherwise."""


def started(otherwise: str = "pass") -> Link:
    return Link([sys.executable, "-c", PROGRAM.replace("OTHERWISE", otherwise)], "the target")


def process_of(running: Link) -> int:
    return running._child.process.pid


def is_alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


def test_what_is_asked_is_answered() -> None:
    with started() as running:
        assert (running.inputs, running.outputs, running.states, running.parameters) == (2, 1, 1, 1)
        assert running.start((1.0, 2.5)).outputs == (3.5,)
        answer = running.update((0.0, -1.0))
    assert (answer.outputs, answer.state, answer.count, answer.stack) == ((-1.0,), (2.0,), 100, 64)


@together(
    "otherwise, message",
    [
        ("time.sleep(60)", "the target hangs: no answer within 1 s"),
        ("sys.stdout.buffer.write(b'ab'), sys.stdout.buffer.flush(), time.sleep(60)", "hangs"),
        ("sys.exit(3)", "the target crashed: a fault of the processor"),
        ("sys.exit('no such memory')", "the target crashed: no such memory"),
        ("import os, signal; os.kill(os.getpid(), signal.SIGKILL)", "the target was lost: ended by SIGKILL"),
        ("sys.exit(0)", "the target crashed: exit code 0"),
    ],
)
def test_what_does_not_answer_is_named_within_a_second_and_ended(otherwise: str, message: str) -> None:
    with started(otherwise) as running:
        running.start((0.0, 0.0))
        running.update((0.0, 0.0))
        begun = time.monotonic()
        with pytest.raises(TargetError, match=message):
            running.update((0.0, 0.0))
        assert time.monotonic() - begun < 2.0
        assert not is_alive(process_of(running))
        with pytest.raises(TargetError, match="the target was lost before"):
            running.update((0.0, 0.0))


def test_what_is_no_program_cannot_be_started(tmp_path: Path) -> None:
    with pytest.raises(TargetError, match=r"the target cannot be started: .*: No such file"):
        Link([str(tmp_path / "nothing")], "the target")


def test_what_says_nothing_at_the_start_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(link, "START_LIMIT", 0.2)
    with pytest.raises(TargetError, match=r"hangs: no answer within 0\.2 s"):
        Link([sys.executable, "-c", "import time; time.sleep(60)"], "the target")


def test_nothing_is_left_when_the_link_is_closed() -> None:
    running = started()
    running.close()
    assert not is_alive(process_of(running))
    running.close()


@pytest.mark.skipif(sys.platform != "linux", reason="of prctl")
@pytest.mark.slow
def test_nothing_is_left_when_the_one_that_started_it_is_killed() -> None:
    """Even if the target hangs and does not see that its link was closed."""
    text = f"""
import sys, time
from fmublocks.target.link import Link
running = Link([sys.executable, "-c", {PROGRAM.replace("OTHERWISE", "time.sleep(60)")!r}], "the target")
print(running._child.process.pid, flush=True)
time.sleep(60)
"""
    with subprocess.Popen([sys.executable, "-c", text], stdout=subprocess.PIPE, text=True) as starter:
        assert starter.stdout
        pid = int(starter.stdout.readline())
        assert is_alive(pid)
        os.kill(starter.pid, signal.SIGKILL)
    end = time.monotonic() + 5.0
    while is_alive(pid) and time.monotonic() < end:
        time.sleep(0.01)
    assert not is_alive(pid)
