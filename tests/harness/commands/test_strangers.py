"""Commands and functions with a plant of somebody else's that misbehaves: one line, an exit code, nothing left."""

import json
import os
import signal
import subprocess
import time
from typing import Any

import pytest
from fmutesting.foreign.stranger import build_stranger
from fmutesting.signals import started
from fmutesting.slow import slow

from driveline.harness.commands.cli import main
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import simulate
from fmuloop.errors import SimulationError
from fmuloop.many_runs import run_many

COMMANDS = {
    "simulate": ["simulate"],
    "compare": ["compare", "--manoeuvre", "tipin15"],
    "replay": ["replay", "harness/manoeuvres/data/town_drive.csv"],
}


@pytest.fixture
def drive(native, tmp_path):
    """Starts a command with a plant; its files for others, and its folder for temporary ones."""
    temporary = tmp_path / "temporary"
    temporary.mkdir()

    def start(command, plant):
        words = [*COMMANDS[command], "--plant", plant, "--fmus", native.parent, "--output", tmp_path / "out"]
        return started("driveline", *words, TMPDIR=temporary)

    return start, temporary


@pytest.mark.parametrize("command", slow(COMMANDS, but=["simulate"]))
def test_a_stranger_that_exits_is_one_line(drive, tmp_path, command):
    start, temporary = drive
    does: Any = {"IN_DO_STEP": 'puts("hello"); if (time > 0.5) exit(0)'}
    running = start(command, build_stranger(tmp_path, **does))
    out, error = running.communicate()
    assert running.returncode == 1
    assert "hello" not in out + error
    (line,) = [line for line in error.splitlines() if "stale" not in line]
    assert line.startswith(f"driveline {command}: ")
    assert "plant (stranger.fmu) ended the process that it ran in, with exit code 0, in fmi2DoStep at 0.5" in line
    assert list(temporary.iterdir()) == []


@pytest.mark.parametrize(
    ("command", "last"), slow([*((each, 0.2) for each in COMMANDS), ("compare", 0.199)], but=[("simulate", 0.2)])
)
def test_a_run_that_a_stranger_ends_has_no_metrics_and_one_of_less_than_200_ms_no_files(
    native, tmp_path, capsys, command, last
):
    does: dict[str, Any] = {"IN_DO_STEP": f"if (time > {last - 5e-4}) return 2"}
    does["IN_GET_BOOLEAN_STATUS"] = "if (kind == 3) { *value = 1; return 0; }"
    plant, out = build_stranger(tmp_path, **does), tmp_path / "out"
    words = [*COMMANDS[command], "--plant", plant, "--fmus", native.parent, "--output", out]
    pages = [] if command == "simulate" else ["--report", out / "page.html"]
    code = main([str(word) for word in [*words, *pages]])
    said = capsys.readouterr()
    why = f"the run ended at {last:g} s"
    if last < 0.2:
        assert code == 1
        assert f"plant (stranger.fmu) ended the run at {last:g} s: there is nothing to evaluate" in said.err
        assert not out.exists()
        return
    assert code == 0
    assert why in said.out
    assert all(why in page.read_text() for page in [*out.glob("*.md"), *out.glob("*.html")])
    remarks = [json.loads(each.read_text()).get("remarks") for each in out.glob("*.json")]
    assert all(run["ended"]["time"] == pytest.approx(0.2) for runs in remarks for run in runs.values())


@pytest.mark.parametrize("number", slow([signal.SIGINT, signal.SIGTERM], but=[signal.SIGTERM]))
def test_a_stranger_that_hangs_ends_with_the_command(drive, tmp_path, number):
    start, temporary = drive
    running = start("simulate", build_stranger(tmp_path, IN_DO_STEP="for (;;) usleep(1000)"))
    while not list(temporary.glob("fmuloop-*/fmuloop-*/binaries")):
        time.sleep(0.05)
        assert running.poll() is None
    hosts = subprocess.run(["pgrep", "-P", str(running.pid)], capture_output=True, text=True, check=True).stdout.split()
    running.send_signal(number)
    running.communicate()
    assert running.returncode != 0
    assert list(temporary.iterdir()) == []
    assert not [host for host in hosts if os.path.exists(f"/proc/{host}")]


@pytest.mark.parametrize("workers", [1, 2])
def test_many_runs_name_the_case_of_a_stranger(native, tmp_path, unpacked, workers):
    plant = build_stranger(tmp_path, IN_DO_STEP="if (time > 0.5) raise(SIGSEGV)")

    def end(v_0):
        return simulate(MANOEUVRES["launch"], plant, parameters={"plant.v_0": v_0}, folder=native.parent)["time"][-1]

    with pytest.raises(SimulationError, match=r"^case 1\.0: plant \(stranger\.fmu\) crashed \(SIGSEGV\) in fmi2DoStep"):
        run_many(end, [1.0, 2.0], workers)
    assert list(unpacked.iterdir()) == []
