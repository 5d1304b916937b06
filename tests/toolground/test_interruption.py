"""However a command is stopped, it says so in one line and leaves nothing behind."""

import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from dataclasses import replace
from errno import ENOSPC
from pathlib import Path
from typing import Any

import pytest
from fmutesting.signals import heed_signals, started
from fmutesting.together import together

from driveline.harness.commands import design
from driveline.harness.commands.cli import main
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.provenance import BEGINS_ANEW
from driveline.harness.simulation.simulate import simulate
from tests import ROOT
from toolground.interruption import Stopped, stoppable, uninterrupted_children, unswallowed

TWO_CORES = {"LOKY_MAX_CPU_COUNT": 2}
"""Environment of a command with workers."""


@pytest.mark.parametrize(
    ("number", "whole_group", "code"),
    [
        (signal.SIGTERM, False, 143),
        pytest.param(signal.SIGHUP, True, 129, marks=pytest.mark.slow),
        (signal.SIGINT, True, 130),
    ],
)
@pytest.mark.slow
def test_a_signal_ends_the_workers_and_leaves_nothing(
    native: Path, tmp_path: Path, number: signal.Signals, whole_group: bool, code: int
) -> None:
    """A terminal that closes or Ctrl-C reaches every process of the group, a `kill` only the first."""
    temporary, results = tmp_path / "temporary", tmp_path / "results"
    temporary.mkdir()
    # long enough to be stopped on its way: all manoeuvres on both plants
    process = started(
        "driveline", "compare", "--fmus", native.parent, "--output", results, **TWO_CORES, TMPDIR=temporary
    )
    deadline = time.monotonic() + 60.0
    while not list(temporary.rglob("*.so")) and time.monotonic() < deadline:
        time.sleep(0.02)  # until a worker has unpacked an FMU
    os.killpg(process.pid, number) if whole_group else process.send_signal(number)
    out, err = process.communicate(timeout=60)
    assert (process.returncode, out, err) == (code, "", f"driveline compare: stopped; {BEGINS_ANEW}\n")
    assert list(temporary.iterdir()) == []
    assert not results.exists()


def test_a_module_that_is_run_is_stopped_like_a_command(tmp_path: Path) -> None:
    process = started("docs.studies", "undetectable_faults", **TWO_CORES, TMPDIR=tmp_path)
    deadline = time.monotonic() + 60.0
    while not list(tmp_path.iterdir()) and time.monotonic() < deadline:
        time.sleep(0.02)
    process.terminate()
    _, err = process.communicate(timeout=60)
    *_, last = err.splitlines()
    assert (process.returncode, last) == (143, "__main__: stopped")
    assert list(tmp_path.iterdir()) == []


MAINS = [
    path
    for folder in ("harness", "benchmarks", "docs/studies")
    for path in (ROOT / folder).rglob("*.py")
    if "\ndef main(" in (text := path.read_text(encoding="utf-8")) and '__name__ == "__main__"' in text
]


@together("path", MAINS)
def test_every_module_that_is_run_is_stopped_so(path: Path) -> None:
    assert path.read_text(encoding="utf-8").endswith('\n\nif __name__ == "__main__":\n    script(main)\n')


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_a_stop_while_workers_begin_waits_until_they_are_known(number: signal.Signals) -> None:
    known = []

    def begin() -> None:
        with stoppable(), uninterrupted_children():
            signal.raise_signal(number)
            known.append("worker")

    before = signal.signal(number, signal.SIG_DFL)  # one that is ignored stays so
    try:
        with pytest.raises(Stopped):
            begin()
    finally:
        signal.signal(number, before)
    assert known == ["worker"]


class Ended(Exception):
    """What the handler of a signal raises."""


def end_in_a_step(number: signal.Signals, over: threading.Event) -> None:
    """Sends the signal to this process while its main thread runs the Python of an FMU in a step.

    An exception while PythonFMU makes an instance would leave the process unable to make another. Threads take turns so
    often here that this one also gets a turn within a step, and not only between two, where PythonFMU gives it one.
    """
    while not over.wait(0.001):
        frame = sys._current_frames().get(threading.main_thread().ident or 0)
        while frame:
            if frame.f_code.co_name == "do_step":
                os.kill(os.getpid(), number)
                return
            frame = frame.f_back


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_is_not_taken_for_a_refusal_of_the_fmu_whose_python_it_meets(
    built: Path, number: signal.Signals
) -> None:
    def end(*_: object) -> None:
        raise Ended

    loop: dict[str, Any] = {"plant": "ValidationVehicle", "folder": built, "build": "python"}
    simulate(replace(MANOEUVRES["drive"], duration=0.01), **loop)  # whose Python has been imported by then
    before = signal.signal(number, end)
    over = threading.Event()
    sender = threading.Thread(target=end_in_a_step, args=(number, over))
    turn = sys.getswitchinterval()
    sys.setswitchinterval(1e-5)
    sender.start()
    try:
        with pytest.raises(Ended):
            simulate(MANOEUVRES["drive"], **loop)
        assert signal.getsignal(number) is end
    finally:
        over.set()
        sender.join()
        sys.setswitchinterval(turn)
        signal.signal(number, before)


@pytest.mark.parametrize("last", ["toolground.errors", "driveline.harness.commands.cli"])
def test_stopped_while_it_is_imported_it_says_so_in_one_line(last: str) -> None:
    """Nothing of the command line is imported before the place that does."""
    program = f"""
import sys
class Stopping:
    def find_spec(self, name, *_):
        if name.startswith("driveline.harness") and "main" not in globals():
            sys.exit("imported before")
        if name == {last!r}:
            raise KeyboardInterrupt
sys.meta_path.insert(0, Stopping())
from driveline.__main__ import main
sys.exit(main())
"""
    done = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "driveline: stopped\n")


def test_a_signal_before_the_command_line_is_there_is_said_and_one_after_it_changes_nothing() -> None:
    program = """
import atexit, os, signal, sys
from driveline.__main__ import main
class Stopping:
    def find_spec(self, name, *_):
        if name == "driveline.harness":
            os.kill(os.getpid(), signal.SIGTERM)
if "early" in sys.argv[1]:
    sys.meta_path.insert(0, Stopping())
for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGINT):
    atexit.register(os.kill, os.getpid(), number)
sys.argv[1:] = ["map", "--help"]
sys.exit(main())
"""
    ends = {}
    for when in ("early", "early, closed", "late"):
        closes = "if 'closed' in sys.argv[1]: sys.stdout = None\n"
        command = [sys.executable, "-c", "import sys\n" + closes + program, when]
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, preexec_fn=heed_signals, check=False)
        ends[when] = done.returncode, done.stdout[:5], done.stderr
    stopped = (143, "", "driveline: stopped\n")
    assert ends == {"early": stopped, "early, closed": stopped, "late": (0, "usage", "")}


def test_a_stop_that_python_makes_another_error_of_is_a_stop() -> None:
    class Stopping:
        def __set_name__(self, owner: type, name: str) -> None:
            signal.raise_signal(signal.SIGTERM)

    before = signal.signal(signal.SIGTERM, signal.SIG_DFL)
    try:
        with pytest.raises(Stopped), stoppable(), unswallowed():
            type("Stopped", (), {"part": Stopping()})
    finally:
        signal.signal(signal.SIGTERM, before)


def test_a_signal_that_is_ignored_stays_so(capsys: pytest.CaptureFixture[str]) -> None:
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        assert main(["design", "--quiet"]) == 0
        assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGHUP, before)


@pytest.mark.parametrize(("arguments", "code"), [(["--help"], 0), (["car"], 1), (["nothing"], 2)])
def test_a_reader_that_has_gone_is_no_traceback(arguments: list[str], code: int) -> None:
    reader, writer = os.pipe()
    os.close(reader)
    command = [sys.executable, "-m", "driveline", *arguments]
    done = subprocess.run(command, cwd=ROOT, stdout=writer, stderr=subprocess.PIPE, text=True, check=False)
    os.close(writer)
    assert done.returncode == code
    assert "Traceback" not in done.stderr
    assert "BrokenPipe" not in done.stderr


def test_a_reader_that_goes_after_the_first_line_leaves_the_run_to_end(native: Path, tmp_path: Path) -> None:
    reader, writer = os.pipe()
    given = ["--manoeuvre", "prbs15", "--fmus", str(native.parent), "--output", str(tmp_path)]
    command = [sys.executable, "-m", "driveline", "simulate", *given]
    with subprocess.Popen(command, cwd=ROOT, stdout=writer, stderr=subprocess.PIPE, text=True) as run:
        os.close(writer)
        assert os.read(reader, 1) == b"p"
        os.close(reader)
        _, err = run.communicate()
    assert err == ""
    assert {path.suffix for path in tmp_path.iterdir()} == {".csv", ".json"}


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no device that is always full")
@pytest.mark.parametrize(("words", "name"), [(["car"], "driveline car"), (["--help"], "driveline")])
def test_a_full_device_is_named_in_one_line(words: list[str], name: str) -> None:
    command = [sys.executable, "-m", "driveline", *words]
    with open("/dev/full", "w", encoding="utf-8") as full:
        done = subprocess.run(command, cwd=ROOT, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert (done.returncode, done.stderr) == (1, f"{name}: standard output: No space left on device\n")


def test_a_full_disk_of_temporary_files_is_not_taken_for_stdout(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(ENOSPC, os.strerror(ENOSPC))

    monkeypatch.setattr(design, "designed", full)
    assert main(["design"]) == 1
    message = f"driveline design: temporary files in {tempfile.gettempdir()}: No space left on device\n"
    assert capsys.readouterr().err == message


@pytest.mark.skipif(os.name != "posix", reason="only shells of POSIX close streams")
@pytest.mark.parametrize("closed", [">&-", "<&- >&- 2>&-"])
@pytest.mark.slow
def test_a_stream_that_is_closed_stops_no_workers_and_is_no_file_of_ours(tmp_path: Path, closed: str) -> None:
    program = """
from driveline.harness.commands import design
from driveline.harness.commands.cli import main
from fmuloop.many_runs import run_many
main(["design", "--quiet", "--output", "gains.toml"])
with open("answers", "w") as file:
    assert file.fileno() > 2
    file.write(str(run_many(abs, [-1, -2], workers=2)))
"""
    shell = ["sh", "-c", f'exec "$0" -c "$1" {closed}', sys.executable, program]
    done = subprocess.run(shell, cwd=tmp_path, env=os.environ | {"PYTHONPATH": str(ROOT)}, check=False)
    assert done.returncode == 0
    assert (tmp_path / "answers").read_text(encoding="utf-8") == "[1, 2]"
    assert (tmp_path / "gains.toml").is_file()
