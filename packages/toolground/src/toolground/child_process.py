"""Programs that are run, compilers and others: none outlives the process that runs it, and what they leave lies in the
folder in which they run."""

import ctypes
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

SET_PARENT_DEATH_SIGNAL = 1
"""Of prctl on Linux."""


def _die_with_parent() -> None:
    """In the process that is being started: has it killed when the one that starts it ends, however that ends."""
    ctypes.CDLL(None).prctl(SET_PARENT_DEATH_SIGNAL, signal.SIGKILL)


BEFORE_START: Callable[[], None] | None = _die_with_parent if sys.platform == "linux" else None
"""What `subprocess` calls before the program starts; other systems tell no program that its parent was killed."""


def run(
    command: Sequence[str | Path],
    folder: Path | None = None,
    environment: Mapping[str, str] | None = None,
    timeout: float | None = None,
    text: bool = True,
    question: bytes | None = None,
) -> "subprocess.CompletedProcess[Any]":
    """Runs a program to its end. Where that is cut short, what it has begun ends with it.

    Args:
        folder: in which it runs and has its temporary files, for who calls to remove; None: the present one, and that
            for temporary files.
        environment: changes of that.
        timeout: in s.
        text: whether what it prints is given as text, or as bytes.
        question: what it reads from stdin, as bytes.

    Raises:
        OSError: there is no such program.
        subprocess.TimeoutExpired: it takes longer.
    """
    temporary = dict.fromkeys(("TMPDIR", "TEMP", "TMP"), str(folder.absolute())) if folder else {}
    process = subprocess.Popen(
        command,
        cwd=folder,
        env={**os.environ, **temporary, **(environment or {})},
        stdin=subprocess.DEVNULL if question is None else subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=text,
        preexec_fn=BEFORE_START,
        process_group=0 if os.name == "posix" else None,
    )
    with process:
        try:
            output, errors = process.communicate(question, timeout)
        except BaseException:
            _kill(process)
            raise
    return subprocess.CompletedProcess(process.args, process.returncode, output, errors)


def output_of(*command: str | Path) -> str:
    """What a program prints, without the space around it.

    Raises:
        OSError: there is no such program.
        subprocess.CalledProcessError: it fails.
    """
    done = run(command)
    done.check_returncode()
    return done.stdout.strip()


def _kill(process: "subprocess.Popen[Any]") -> None:
    """And what it has begun."""
    if os.name == "posix":
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
    process.kill()
