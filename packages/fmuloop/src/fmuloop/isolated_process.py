"""An isolated process for FMUs that are not ours: one that exits, crashes or hangs there is a message here."""

import os
import pickle
import signal
import subprocess
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from math import isfinite
from mmap import mmap
from pathlib import Path
from queue import Empty, Queue
from tempfile import TemporaryDirectory
from threading import Thread
from time import monotonic
from typing import Any

from .call_trace import AT_START, FUNCTIONS, CallRecord
from .errors import InstantiationError, SimulationError, UnpackedFolderError
from .process_answers import Answer, Bytes, InvalidAnswer, receive

POLL = 0.1
"""Seconds between two readings of the call trace."""

PATIENCE = 5.0
"""Seconds in which it must have ended when it is no longer needed."""

PAGE = 4096


class IsolatedProcess:
    """A process that answers one question at a time, and a folder for its files that vanishes with it.

    Attributes:
        folder: for temporary files.
    """

    def __init__(self, names: Sequence[str], longest_call: float, folder: Path | None = None) -> None:
        """Starts it.

        Args:
            names: of the FMUs, as messages name them; by the numbers that the call trace notes.
            longest_call: seconds that a call of an FMU may last.
            folder: in which that of the process is made; None: that for temporary files.
        """
        self._names = names
        self._longest_call = longest_call
        self._files = TemporaryDirectory(prefix="fmuloop-", dir=folder, ignore_cleanup_errors=True)
        self.folder = Path(self._files.name)
        page = self.folder / "call_trace"
        page.write_bytes(bytes(PAGE))
        with page.open("r+b") as file:
            self._memory = mmap(file.fileno(), PAGE)
        start = f"import sys; sys.path[:] = {sys.path!r}; from {__package__}.process_host import main; main()"
        self._process = subprocess.Popen(
            [sys.executable, "-c", start, str(page)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            bufsize=0,  # a thread that waits in a buffered reader does not let the interpreter end
            env=os.environ | dict.fromkeys(("TMPDIR", "TEMP", "TMP"), self._files.name),
            start_new_session=True,
        )
        self._was_killed = self._has_invalid = False
        self._size = 0
        self._answers: Queue[Answer | None] = Queue()
        Thread(target=self._listen, daemon=True).start()

    def ask(self, function: Callable[..., Any], *arguments: Any) -> list[str]:
        """The texts that a function, one that can be imported, answers in the process; none for None.

        Raises:
            SimulationError: an FMU has ended the process, or a call lasts too long; of no more use then.
            UnpackedFolderError: an FMU cannot be instantiated, and the folder has a name that some cannot take.
            Exception: what the function raised, if it is one of `harness.cosimulation.process_answers.ERRORS`.
        """
        try:
            return list(self._asked(function, arguments, 0, None).texts)
        except SimulationError as error:
            called = FUNCTIONS[self._at()[1] - 1]
            fails = isinstance(error, InstantiationError) or (not self.alive and "Instantiate" in called)
            # PythonFMU decodes no more than %20 of the path of its resources
            if str(self.folder).isascii() or not fails:
                raise
            where = f"{self.folder.parent}, whose name is not plain ASCII, which some FMUs cannot take; see TMPDIR"
            raise UnpackedFolderError(f"{error}; it was unpacked to {where}") from error

    def fetch(
        self, size: int, function: Callable[..., Any], *arguments: Any, watch: Callable[[float], None] | None = None
    ) -> Bytes:
        """So many bytes, which a function answers in the process; raises as `ask` does.

        Args:
            watch: is called now and then with the time in s at which the FMUs are.
        """
        return self._asked(function, arguments, size, watch).content

    def _asked(
        self, function: Callable[..., Any], arguments: Sequence[Any], size: int, watch: Callable[[float], None] | None
    ) -> Answer:
        if not self.alive:
            raise SimulationError(self._ended())
        self._size = size
        try:
            self._send(pickle.dumps((function, arguments), pickle.HIGHEST_PROTOCOL))
            answer = self._wait(watch)
        except BaseException:
            self._kill()  # an answer that comes later would be taken for that to the next question
            raise
        if answer is None:
            self._kill(0.0 if self._has_invalid else PATIENCE)
            raise SimulationError(self._ended())
        if answer.error is not None:
            raise answer.error
        return answer

    def _send(self, question: bytes) -> None:
        assert self._process.stdin is not None
        left = memoryview(question)
        with suppress(BrokenPipeError):
            while left:
                left = left[self._process.stdin.write(left) :]

    def _wait(self, watch: Callable[[float], None] | None) -> Answer | None:
        seen, since = self._at(), monotonic()
        while True:
            alive = self.alive  # before the answers are read: the last one may just have come
            with suppress(Empty):
                return self._answers.get(timeout=POLL)
            if not alive:
                return None  # what it has begun and left behind may hold the pipe open
            now = self._at()
            if now != seen:
                seen, since = now, monotonic()
            elif now[1] and monotonic() - since > self._longest_call:
                raise SimulationError(f"{self._call('did not return from')} within {self._longest_call:g} s")
            if watch and now[2] >= 0.0:
                watch(now[2])

    def close(self) -> None:
        """Ends it and removes its files."""
        assert self._process.stdin is not None
        self._process.stdin.close()
        self._kill(PATIENCE)
        self._files.cleanup()

    def _listen(self) -> None:
        """Passes on answers until the process has ended, or has written what is none."""
        assert self._process.stdout is not None
        try:
            while True:
                self._answers.put(receive(self._process.stdout.read, lambda: self._size))
        except InvalidAnswer:
            self._has_invalid = True
        except (EOFError, OSError, MemoryError):
            pass
        self._answers.put(None)

    @property
    def alive(self) -> bool:
        return self._process.poll() is None

    def _kill(self, patience: float = 0.0) -> None:
        """Ends it, unless it ends by itself in so many seconds, and all that it has started."""
        try:
            self._process.wait(patience)
        except subprocess.TimeoutExpired:
            self._was_killed = True
        if sys.platform == "win32":
            self._process.kill()
        else:
            with suppress(ProcessLookupError, PermissionError):
                os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait()

    def _ended(self) -> str:
        if self._has_invalid:
            return self._call("wrote among the answers of the process that it ran in, in")
        if self._was_killed:
            return self._call("gave no more answers and was ended, in")
        code = self._process.returncode
        if code >= 0:
            return self._call(f"ended the process that it ran in, with exit code {code}, in")
        return self._call(f"crashed ({_name(-code)}) in")

    def _at(self) -> tuple[int, int, float, int]:
        """What is noted; no call, if an FMU has written over it."""
        at = CallRecord.from_buffer_copy(self._memory)
        known = 0 <= at.instance < len(self._names) and 0 <= at.function <= len(FUNCTIONS) and isfinite(at.time)
        return (at.instance, at.function, at.time, at.calls) if known else (0, 0, AT_START, 0)

    def _call(self, what: str) -> str:
        """Which FMU did that in which call."""
        instance, function, time, _ = self._at()
        if not function:
            return f"{', '.join(dict.fromkeys(self._names))} {what} no call of FMI"
        when = f" at {time:g} s" if time >= 0.0 else ""
        return f"{self._names[instance]} {what} {FUNCTIONS[function - 1]}{when}"


def _name(number: int) -> str:
    """Of a signal; those of real time have none."""
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
