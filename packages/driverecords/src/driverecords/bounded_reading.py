"""Files that unpack to more than they are, and packages that crash, hang or swell over damaged ones: they are read by a
process of its own, with limits of time and memory.

What a file says of its size would be quicker to check, but is written by whoever wrote the file; and no package lets
itself be told how much it may unpack. A limit of the operating system holds for all of them, known faults and others.
"""

import os
import pickle
import signal
import subprocess
import sys
from collections.abc import Callable
from functools import wraps
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, TypeVar, cast

from toolground.child_process import run
from toolground.errors import UserError
from toolground.file_limits import MEMORY, PATIENCE, SECONDS, SMALL_TEXT
from toolground.interruption import end_with
from toolground.plain_text import plain, words

from .format_detection import is_text
from .source import RecordingError

try:
    import resource
except ImportError:  # Windows
    resource = None

OUT_OF_TIME = -signal.SIGXCPU if resource else None
"""Exit code of a process that has computed for too long; Windows has none."""

FEW_THREADS = {"ARROW_DEFAULT_MEMORY_POOL": "system", "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
"""Environment in which packages reserve no memory for threads and data that there may never be."""


Read = TypeVar("Read", bound=Callable[..., Any])


def bounded(read: Read) -> Read:
    """The function, which reads the recording at its first argument, with limits.

    Raises:
        RecordingError: the file takes more than recordings do, or ends the process that reads it.
    """

    @wraps(read)
    def limited(path: Path, *arguments: Any, **named: Any) -> Any:
        path = Path(path)
        if not path.is_file() or (is_text(path) and path.stat().st_size <= SMALL_TEXT):
            return read(path, *arguments, **named)
        answer = _asked(path, (read.__module__, read.__name__, (path, *arguments), named))
        if isinstance(answer, UserError):
            raise answer
        return answer

    return cast(Read, limited)


def _asked(path: Path, question: Any) -> Any:
    patience = PATIENCE if resource else SECONDS
    start = f"import sys; sys.path[:] = {sys.path!r}; from {__name__} import main; main({os.getpid()})"
    command, asked = [sys.executable, "-c", start], pickle.dumps(question)
    with TemporaryDirectory() as temporary:  # packages leave copies of damaged files, and processes that are killed all
        environment = FEW_THREADS | dict.fromkeys(("TMPDIR", "TEMP", "TMP"), temporary)
        try:
            done = run(command, environment=environment, timeout=patience, text=False, question=asked)
        except subprocess.TimeoutExpired as late:
            raise _late(path, patience) from late
    if done.returncode == OUT_OF_TIME:
        raise _late(path, SECONDS)
    if done.returncode:
        last = plain(done.stderr.decode(errors="replace").strip().rpartition("\n")[2], 200)
        raise RecordingError(f"{path} ended the process that read it: {last or f'exit code {done.returncode}'}")
    return pickle.loads(done.stdout)


def _late(path: Path, seconds: float) -> RecordingError:
    return RecordingError(f"{path} takes more than {seconds} s to read")


def main(parent: int) -> None:
    """In the process: reads one file, and answers with what it holds or why it cannot be read."""
    end_with(parent)
    question = pickle.load(sys.stdin.buffer)
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what packages print is no answer
    if resource:
        resource.setrlimit(resource.RLIMIT_DATA, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS + 1))
    with answers:
        pickle.dump(outcome(*question), answers, pickle.HIGHEST_PROTOCOL)
    sys.stderr.flush()
    os._exit(0)  # freeing what is read takes time


def outcome(module: str, name: str, arguments: tuple[Any, ...], named: dict[str, Any]) -> Any:
    """What the function, by its module and name, reads from the file; or the error that says why it cannot."""
    path = arguments[0]
    try:
        return getattr(import_module(module), name).__wrapped__(*arguments, **named)
    except UserError as refusal:
        return refusal
    except MemoryError:
        return RecordingError(f"{path} takes more than {MEMORY / 1e6:.0f} MB of memory to read")
    except Exception as fault:
        return RecordingError(f"{path} cannot be read: {plain(words(fault), 200)}")
