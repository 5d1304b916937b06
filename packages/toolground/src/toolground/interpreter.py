"""Interpreters that run a function of a module, with limits of time and memory: what a file or a binary of anybody does
to them is told in a line.

```python
answer = call(read, path, limits=Limits(wall=300.0, computing=30, memory=10**9))  # once
child = Interpreter(host)  # for many questions
child.send(question)
answer = child.read(size, within=1.0)
```
"""

import os
import pickle
import signal
import subprocess
import sys
from collections.abc import Callable, Mapping
from functools import partial
from importlib import import_module
from pathlib import Path
from shutil import rmtree
from tempfile import TemporaryDirectory
from typing import Any, BinaryIO, NamedTuple

from .child_process import Child, temporary_in
from .interruption import end_with

try:
    import resource
except ImportError:  # Windows
    resource = None

OUT_OF_TIME = -getattr(signal, "SIGXCPU", 0) or None
"""Exit code of a process that has computed for too long; Windows has none."""

Host = Callable[[BinaryIO, BinaryIO], object]
"""What an interpreter runs, a function of a module: reads questions from one pipe and writes answers to another."""


class Interpreter(Child):
    """A Python of its own, which finds the modules that this one finds; what it prints goes to stderr.

    Attributes:
        folder: for its temporary files; vanishes with it, even if the process that began it is killed.
    """

    _before_start = None  # a thread that began it may end before it: it looks for the process itself

    def __init__(
        self,
        host: Host,
        folder: Path | None = None,
        environment: Mapping[str, str] | None = None,
        stderr: int | None = subprocess.DEVNULL,
        tidy: Callable[[Path], object] = lambda _: None,
    ) -> None:
        """Begins it; args as of Child, but for `folder`, in which its own is made (None: that for temporary files), and
        `tidy`, which is called with its own when it has ended, before that vanishes."""
        self._tidy = tidy
        prefix = f"{host.__module__.partition('.')[0]}-"
        self._files = TemporaryDirectory(prefix=prefix, dir=folder, ignore_cleanup_errors=True)
        self.folder = Path(self._files.name)
        which = os.getpid(), self._files.name, host.__module__, host.__name__
        code = f"import sys; sys.path[:] = {sys.path!r}; from {__name__} import _run_host; _run_host(*{which!r})"
        changes = temporary_in(self.folder) | dict(environment or {})
        super().__init__([sys.executable, "-c", code], None, changes, stderr)

    def end(self, patience: float = 0.0) -> bool:
        by_itself = super().end(patience)
        self._tidy(self.folder)
        self._files.cleanup()
        return by_itself


def _run_host(parent: int, folder: str, module: str, name: str) -> None:
    """In an interpreter that was begun for another process."""
    tidy = partial(rmtree, folder, ignore_errors=True)
    end_with(parent, tidy)
    questions, answers = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    os.dup2(2, 1)  # what packages and FMUs print is no answer
    try:
        getattr(import_module(module), name)(questions, answers)
        answers.flush()
    finally:
        tidy()  # there may be no parent any more
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)  # freeing what was read takes time, and what FMUs have registered to be done at exit is not done


class Limits(NamedTuple):
    """What a call in an interpreter of its own may take.

    Attributes:
        wall: seconds, whatever it does.
        computing: seconds of the processor.
        memory: bytes of data.

    Windows limits neither computing nor memory: there it has as long in all as it may compute.
    """

    wall: float
    computing: int
    memory: int


class ChildError(Exception):
    """A child that has ended without an answer; the text is its last line, or its exit code."""


def call(
    function: Callable[..., Any], *arguments: Any, limits: Limits, environment: Mapping[str, str] | None = None
) -> Any:
    """What a function of a module answers in an interpreter of its own. Both are pickled.

    Args:
        environment: changes of that.

    Raises:
        TimeoutError: it takes longer; says how long.
        ChildError: it has ended that interpreter. Where memory is lacking, Python has raised a MemoryError there.
    """
    child = Interpreter(_answer, environment=environment, stderr=subprocess.PIPE)
    seconds = limits.wall if resource else limits.computing
    try:
        answer, errors = child.process.communicate(pickle.dumps((limits, function, arguments)), seconds)
    except subprocess.TimeoutExpired as late:
        raise TimeoutError(f"takes more than {seconds} s") from late
    finally:
        child.end()
    code = child.process.returncode
    if code == OUT_OF_TIME:
        raise TimeoutError(f"takes more than {limits.computing} s")
    if code:
        raise ChildError(errors.decode(errors="replace").strip().rpartition("\n")[2] or f"exit code {code}")
    return pickle.loads(answer)


def _answer(questions: BinaryIO, answers: BinaryIO) -> None:
    limits, function, arguments = pickle.load(questions)
    if resource:
        resource.setrlimit(resource.RLIMIT_DATA, (limits.memory, limits.memory))
        resource.setrlimit(resource.RLIMIT_CPU, (limits.computing, limits.computing + 1))
    pickle.dump(function(*arguments), answers, pickle.HIGHEST_PROTOCOL)
