"""Programs that are run, compilers and others: none outlives the process that runs it, and all that one has begun ends
with it."""

import ctypes
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import partial
from math import inf
from pathlib import Path
from queue import Empty, Queue
from threading import Thread
from time import monotonic
from typing import Any

SET_PARENT_DEATH_SIGNAL = 1
"""Of prctl on Linux."""

AT_ONCE, MOST_WAITING = 2**16, 16
"""Bytes that are read at once, and how many such pieces wait: memory is taken for what was asked for alone."""

POLL = 0.1
"""Seconds between two looks whether a child that says nothing is alive."""

BEFORE_START: Callable[[], object] | None = None
"""What `subprocess` calls before a program starts: has it killed when the thread that starts it ends, however that
ends. Other systems than Linux tell no program that its parent was killed."""
if sys.platform == "linux":  # loaded here, since after a fork another thread may hold the lock of the loader
    BEFORE_START = partial(ctypes.CDLL(None).prctl, SET_PARENT_DEATH_SIGNAL, getattr(signal, "SIGKILL", 9))


class Child:
    """A program with pipes to it. It has a session of its own, so nothing from the terminal reaches it.

    Attributes:
        process: as `subprocess` has it.
        errors: what it printed to stderr, once it has ended.
        closed: whether it was ended from here.
    """

    _before_start = staticmethod(BEFORE_START) if BEFORE_START else None

    def __init__(
        self,
        command: Sequence[str | Path],
        folder: Path | None = None,
        environment: Mapping[str, str] | None = None,
        stderr: int | None = subprocess.PIPE,
    ) -> None:
        """Begins it in a folder (None: the present one) with changes of the environment; `stderr` as of `subprocess`.

        Raises:
            OSError: there is no such program.
        """
        self.errors = b""
        self.closed = False
        self._pieces: Queue[bytes] = Queue(MOST_WAITING)
        self._received = bytearray()
        self._listener: Thread | None = None
        self.process = subprocess.Popen(
            command,
            cwd=folder,
            env={**os.environ, **(environment or {})},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=stderr,
            bufsize=0,  # a thread that waits in a buffered reader does not let the interpreter end
            preexec_fn=self._before_start,
            start_new_session=True,
        )
        assert self.process.stdin
        assert self.process.stdout
        self._stdin, self._stdout = self.process.stdin, self.process.stdout

    @property
    def alive(self) -> bool:
        return self.process.poll() is None

    def send(self, content: bytes) -> None:
        """Writes to its stdin; what has ended reads nothing, and `read` says so."""
        left = memoryview(content)
        with suppress(BrokenPipeError):
            while left:
                left = left[self._stdin.write(left) :]

    def read(self, size: int, within: float = inf) -> bytearray:
        """So many bytes that it writes to stdout.

        Args:
            within: seconds.

        Raises:
            TimeoutError: it takes longer; what has come is there for the next reading.
            EOFError: it has ended, or has closed its stdout.
        """
        if self._listener is None:
            self._listener = Thread(target=self._listen, daemon=True)
            self._listener.start()
        end = monotonic() + within
        while len(self._received) < size:
            alive = self.alive  # before the pipe is looked at: the last answer may just have come
            try:
                piece = self._pieces.get(timeout=max(min(POLL, end - monotonic()), 0.0))
            except Empty:
                if not alive:  # what it has begun and left behind may hold the pipe open
                    raise EOFError from None
                if monotonic() >= end:
                    raise TimeoutError from None
                continue
            if not piece:
                raise EOFError
            self._received += piece
        content, self._received = self._received, self._received[size:]
        del content[size:]
        return content

    def _listen(self) -> None:
        with self._stdout, suppress(OSError):
            while piece := self._stdout.read(AT_ONCE):
                self._pieces.put(piece)
        self._pieces.put(b"")

    def end(self, patience: float = 0.0) -> bool:
        """Nothing of it is left. Whether it ended by itself.

        Args:
            patience: seconds in which it may, now that nothing more is sent.
        """
        if self.closed:
            return True
        self.closed = True
        self._stdin.close()
        by_itself = True
        try:
            self.process.wait(patience)
        except subprocess.TimeoutExpired:
            by_itself = False
        if os.name == "posix":  # what it has begun too
            with suppress(ProcessLookupError, PermissionError):
                os.killpg(self.process.pid, signal.SIGKILL)
        self.process.kill()
        self.process.wait()
        if self.process.stderr and not self.process.stderr.closed:
            with self.process.stderr as stream:
                self.errors = stream.read()
        if self._listener is None:
            self._stdout.close()
        with suppress(Empty):  # the listener may wait until somebody takes what it has read
            while True:
                self._pieces.get_nowait()
        return by_itself


def temporary_in(folder: Path) -> dict[str, str]:
    """The changes of an environment whose temporary files lie in a folder."""
    return dict.fromkeys(("TMPDIR", "TEMP", "TMP"), str(folder.absolute()))


def run(
    command: Sequence[str | Path],
    folder: Path | None = None,
    environment: Mapping[str, str] | None = None,
    timeout: float | None = None,
    text: bool = True,
) -> "subprocess.CompletedProcess[Any]":
    """Runs a program to its end. Where that is cut short, what it has begun ends with it.

    Args:
        folder: in which it runs and has its temporary files, for who calls to remove; None: the present one, and that
            for temporary files.
        environment: changes of that.
        timeout: in s.
        text: whether what it prints is given as text, or as bytes.

    Raises:
        OSError: there is no such program.
        subprocess.TimeoutExpired: it takes longer.
    """
    temporary = temporary_in(folder) if folder else {}
    child = Child(command, folder, temporary | dict(environment or {}))
    try:
        printed = child.process.communicate(timeout=timeout)
    finally:
        child.end()
    output, errors = (part.decode(errors="replace") if text else part for part in printed)
    return subprocess.CompletedProcess(child.process.args, child.process.returncode, output, errors)


def output_of(*command: str | Path) -> str:
    """What a program prints, without the space around it.

    Raises:
        OSError: there is no such program.
        subprocess.CalledProcessError: it fails.
    """
    done = run(command)
    done.check_returncode()
    return done.stdout.strip()


def signal_name(number: int) -> str:
    """Those of real time have none."""
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
