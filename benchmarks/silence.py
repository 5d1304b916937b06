"""How long `driveline` shows nothing, on a terminal and with its output piped: `python -m benchmarks.silence`.

Every command is run with its defaults or with less to do, and stopped after `--limit` seconds. Shown are the time to
the first output and the longest time without any, also over that of `python -c "import numpy"`, which runs before
each: the seconds are those of the machine and of what else it does.
"""

import argparse
import os
import pty
import select
import subprocess
import sys
import tempfile
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import NamedTuple

from rich.console import Console
from rich.table import Table

from benchmarks.start_up import environment
from driveline.harness.base.interruption import script

ROOT = Path(__file__).parents[1]

DRIVE = str(ROOT / "harness/manoeuvres/data/town_drive.csv")

COMMANDS = (
    "--version",
    "build --output fmus",
    "simulate",
    "simulate --build python",
    "simulate --manoeuvre drive --plot",
    "compare",
    f"replay {DRIVE}",
    "record",
    "identify recording.csv",
    "faults --cases 20",
    "robustness --cases 5",
    "explore",
    f"check {ROOT}/build/DampingController.fmu {ROOT}/build/native/DampingController.fmu",
    "design",
    "design --search searched",
    "analyse",
    "target export",
    "target build",
    "target image",
    "target record",
    "bus",
)

RECORD = ("-m", "driveline", "record", "--plant", "ValidationVehicle", "--quiet", "--output", "recorded")


class Silence(NamedTuple):
    """Seconds to the first output, of the longest time without any, and in all; whether it was stopped then."""

    first: float
    longest: float
    total: float
    stopped: bool


def silence(arguments: list[str], folder: Path, piped: bool, limit: float) -> Silence:
    """Runs Python with these arguments in a folder, its errors on a terminal, its output there too or piped."""
    screen, terminal = pty.openpty()
    pipe_end, pipe = os.pipe() if piped else (None, None)
    began = last = perf_counter()
    process = subprocess.Popen(
        [sys.executable, *arguments],
        cwd=folder,
        env=environment() | {"TERM": "xterm"},
        stdin=subprocess.DEVNULL,
        stdout=terminal if pipe is None else pipe,
        stderr=terminal,
    )
    os.close(terminal)
    if pipe is not None:
        os.close(pipe)
    sources = {end for end in (screen, pipe_end) if end is not None}
    first, longest, stopped = None, 0.0, False
    while sources:
        ready, _, _ = select.select(list(sources), [], [], 0.1)
        now = perf_counter()
        for source in ready:
            if not _read(source):
                sources.remove(source)
            else:
                first, longest, last = first or now - began, max(longest, now - last), now
        if not stopped and now - began > limit:
            stopped = True
            longest = max(longest, now - last)
            process.terminate()
    process.wait()
    os.close(screen)
    if pipe_end is not None:
        os.close(pipe_end)
    total = perf_counter() - began
    if not stopped:
        longest = max(longest, began + total - last)
    return Silence(first or total, longest, total, stopped)


def _read(source: int) -> bytes:
    try:
        return os.read(source, 65536)
    except OSError:  # what a terminal says when nobody has it open any more
        return b""


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.silence", description=__doc__)
    parser.add_argument("--limit", type=float, default=20.0, help="seconds of each command (default: %(default)g)")
    parser.add_argument("--only", default="", metavar="COMMAND", help="those that begin so (default: all)")
    args = parser.parse_args()
    table = Table("", "stdout", "first, s", "over numpy", "longest silence, s", "over numpy", "in all, s")
    with TemporaryDirectory() as folder:
        recording = _recording(Path(folder)) if "identify".startswith(args.only[:8]) else None
        for command in COMMANDS:
            for piped in (False, True):
                if command.startswith(args.only):
                    place = Path(tempfile.mkdtemp(dir=folder))
                    if recording:
                        (place / "recording.csv").symlink_to(recording)
                    unit = silence(["-c", "import numpy"], place, False, args.limit).total
                    found = silence(["-m", "driveline", *command.split()], place, piped, args.limit)
                    table.add_row(
                        command.replace(f"{ROOT}/", ""), "piped" if piped else "terminal", *_cells(found, unit)
                    )
    Console().print(table)


def _recording(folder: Path) -> Path:
    """A recording for `driveline identify`."""
    subprocess.run([sys.executable, *RECORD], cwd=folder, check=True)
    (path,) = folder.glob("recorded/*_off.csv")
    return path


def _cells(found: Silence, unit: float) -> list[str]:
    times = (found.first, found.first / unit, found.longest, found.longest / unit)
    return [*(f"{time:.1f}" for time in times), f"{'stopped at ' * found.stopped}{found.total:.1f}"]


if __name__ == "__main__":
    script(main)
