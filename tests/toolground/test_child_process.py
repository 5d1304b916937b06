"""Programs that are run end with what runs them, and leave nothing behind."""

import os
import signal
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from time import monotonic, sleep

import pytest
from fmutesting.signals import heed_signals

from toolground import child_process
from toolground.child_process import Child, output_of, run, signal_name

ROOT = Path(__file__).parents[2]

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="other systems tell no program that its parent is gone")

STAND_IN = """#!/bin/sh
echo temporary > "$TMPDIR/of_compiler.s"
sleep 60 &
echo "$$ $!" > '{notes}.part'
mv '{notes}.part' '{notes}'
wait
"""
"""Takes a minute, and begins another process, as compilers do."""

CHECK = """
from docs.studies import target_deviations as deviations
deviations.require_packages = lambda *_: None
deviations.CHECKER = deviations.COMPILER = {program!r}
deviations.findings({})
"""

COMPILE = """
from fmublocks.native.compiler import host_binaries
host_binaries("FMU", {"all.c": b""})
"""


@pytest.fixture
def begun(tmp_path: Path):
    """Begins Python that runs the stand-in; gives it with the numbers of the stand-in and of what that has begun."""
    program, notes, temporary = tmp_path / "stand_in", tmp_path / "notes", tmp_path / "temporary"
    program.write_text(STAND_IN.format(notes=notes))
    program.chmod(0o755)
    temporary.mkdir()
    processes: list[subprocess.Popen[bytes]] = []

    def begin(code: str) -> tuple["subprocess.Popen[bytes]", list[int]]:
        environment = os.environ | {"CC": str(program), "TMPDIR": str(temporary)}
        command = [sys.executable, "-c", code.replace("{program!r}", repr(str(program)))]
        quiet = subprocess.DEVNULL
        processes.append(subprocess.Popen(command, env=environment, cwd=ROOT, stderr=quiet, preexec_fn=heed_signals))
        wait_until(notes.exists)
        return processes[-1], [int(number) for number in notes.read_text().split()]

    yield begin
    for process in processes:
        process.kill()
        process.wait()
    if notes.exists():
        for number in notes.read_text().split():
            with suppress(ProcessLookupError):
                os.kill(int(number), signal.SIGKILL)


def wait_until(condition: Callable[[], bool]) -> None:
    end = monotonic() + 60.0
    while not condition():
        assert monotonic() < end, "it takes too long"
        sleep(0.05)


def gone(number: int) -> bool:
    """Whether a process has ended; one that nobody has waited for yet has."""
    try:
        return Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except OSError:
        return True


@pytest.mark.parametrize("code", [CHECK, COMPILE])
def test_a_program_ends_with_a_process_that_is_killed(begun, code: str) -> None:
    process, (program, _) = begun(code)
    process.kill()
    wait_until(lambda: gone(program))


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_build_that_is_stopped_leaves_no_process_and_no_file(begun, tmp_path: Path, number: signal.Signals) -> None:
    stopped = f"from toolground.interruption import script\ndef main():{COMPILE}\nscript(main)"
    process, programs = begun(
        stopped.replace("\nhost", "\n    host").replace("\nfrom fmublocks", "\n    from fmublocks")
    )
    process.send_signal(number)
    assert process.wait(60) == 128 + number
    wait_until(lambda: all(map(gone, programs)))
    assert list((tmp_path / "temporary").iterdir()) == []


@pytest.mark.slow
def test_what_takes_too_long_is_ended_with_what_it_has_begun(tmp_path: Path) -> None:
    with pytest.raises(subprocess.TimeoutExpired):
        run(["/bin/sh", "-c", "sleep 60 & echo $! > child; wait"], tmp_path, timeout=1.0)
    wait_until(lambda: gone(int((tmp_path / "child").read_text())))


def test_a_program_gets_changes_of_the_environment_and_nothing_to_read(tmp_path: Path) -> None:
    code = "import os, sys; print(os.environ['ASKED'], os.getcwd(), sys.stdin.buffer.read())"
    changes = {"ASKED": "so"}
    done = run([sys.executable, "-c", code], environment=changes, text=False)
    assert done.stdout.decode().split() == ["so", os.getcwd(), "b''"]
    assert run([sys.executable, "-c", code], tmp_path, changes).stdout.split() == ["so", str(tmp_path), "b''"]


def test_what_a_program_prints_is_given_only_if_it_does_not_fail() -> None:
    assert output_of(sys.executable, "-c", "print(' 1 2 ')") == "1 2"
    with pytest.raises(subprocess.CalledProcessError):
        output_of(sys.executable, "-c", "raise SystemExit(3)")


def test_what_does_not_end_in_time_is_ended() -> None:
    program = Child([sys.executable, "-c", "import time; print(1, flush=True); time.sleep(60)"])
    assert program.read(1) == b"1"
    assert not program.end(patience=0.2)
    assert signal_name(-program.process.returncode) == "SIGKILL"


def test_of_a_flood_no_more_is_taken_than_was_asked_for_and_some_pieces() -> None:
    program = Child([sys.executable, "-c", "import os\nwhile True: os.write(1, bytes(2**20))"])
    assert program.read(10) == bytes(10)
    sleep(0.3)
    assert program._pieces.qsize() == child_process.MOST_WAITING
    program.end()
    assert program._listener
    program._listener.join(60.0)
    assert not program._listener.is_alive()


def test_signals_of_real_time_have_a_number() -> None:
    assert [signal_name(number) for number in (signal.SIGSEGV, 41)] == ["SIGSEGV", "signal 41"]
