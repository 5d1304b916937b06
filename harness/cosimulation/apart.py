"""A process of its own for FMUs that are not ours: one that exits, crashes or hangs there is a message here."""

import os
import pickle
import signal
import subprocess
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from mmap import mmap
from pathlib import Path
from queue import Empty, Queue
from tempfile import TemporaryDirectory
from threading import Thread
from time import monotonic
from typing import Any

from ..errors import SimulationError
from .whereabouts import FUNCTIONS, Whereabouts

LOOK = 0.1
"""Seconds between two looks at what the process is doing."""

PATIENCE = 5.0
"""Seconds in which it must have ended when it is no longer needed."""

PAGE = 4096


class Apart:
    """A process that answers one question at a time, and a folder for its files that vanishes with it.

    Attributes:
        folder: for temporary files.
    """

    def __init__(self, names: Sequence[str], longest_call: float, folder: Path | None = None) -> None:
        """Starts it.

        Args:
            names: of the FMUs, as messages name them; by the numbers that `whereabouts` notes.
            longest_call: seconds that a call of an FMU may last.
            folder: in which that of the process is made; None: that for temporary files.
        """
        self._names = names
        self._longest_call = longest_call
        self._files = TemporaryDirectory(prefix="driveline-", dir=folder, ignore_cleanup_errors=True)
        self.folder = Path(self._files.name)
        page = self.folder / "whereabouts"
        page.write_bytes(bytes(PAGE))
        with page.open("r+b") as file:
            self._memory = mmap(file.fileno(), PAGE)
        start = f"import sys; sys.path[:] = {sys.path!r}; from {__package__}.host import main; main()"
        self._process = subprocess.Popen(
            [sys.executable, "-c", start, str(page)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env=os.environ | dict.fromkeys(("TMPDIR", "TEMP", "TMP"), self._files.name),
            start_new_session=True,
        )
        self._was_killed = False
        self._answers: Queue[tuple[Any, Exception | None] | None] = Queue()
        Thread(target=self._listen, daemon=True).start()

    def ask(self, function: Callable[..., Any], *arguments: Any, watch: Callable[[float], None] | None = None) -> Any:
        """What a function, one that can be imported, answers in the process.

        Args:
            watch: is called now and then with the time in s at which the FMUs are.

        Raises:
            SimulationError: an FMU has ended the process, or a call lasts too long; of no more use then.
            Exception: what the function raised.
        """
        with suppress(BrokenPipeError):
            assert self._process.stdin is not None
            pickle.dump((function, arguments), self._process.stdin, pickle.HIGHEST_PROTOCOL)
            self._process.stdin.flush()
        try:
            answer = self._wait(watch)
        except BaseException:
            self._kill()  # an answer that comes later would be taken for that to the next question
            raise
        if answer is None:
            self._answers.put(None)  # for whoever asks again
            self._kill(PATIENCE)
            raise SimulationError(self._ended())
        value, error = answer
        if error is not None:
            raise error
        return value

    def _wait(self, watch: Callable[[float], None] | None) -> tuple[Any, Exception | None] | None:
        seen, since = self._at(), monotonic()
        while True:
            try:
                return self._answers.get(timeout=LOOK)
            except Empty:
                now = self._at()
            if now != seen:
                seen, since = now, monotonic()
            elif now[1] and monotonic() - since > self._longest_call:
                raise SimulationError(f"{self._call('did not return from')} within {self._longest_call:g} s")
            if watch and now[2] >= 0.0:
                watch(now[2])

    def close(self) -> None:
        """Ends it and removes its files."""
        with suppress(BrokenPipeError):
            assert self._process.stdin is not None
            self._process.stdin.close()
        self._kill(PATIENCE)
        self._files.cleanup()

    def _listen(self) -> None:
        """Passes on answers until the process has ended."""
        assert self._process.stdout is not None
        with suppress(Exception):  # an FMU may write what it likes, where it likes
            while True:
                self._answers.put(pickle.load(self._process.stdout))
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
        if self._was_killed:
            return self._call("gave no more answers and was ended, in")
        code = self._process.returncode
        if code >= 0:
            return self._call(f"ended the process that it ran in, with exit code {code}, in")
        return self._call(f"crashed ({_name(-code)}) in")

    def _at(self) -> tuple[int, int, float, int]:
        at = Whereabouts.from_buffer_copy(self._memory)
        return at.instance, at.function, at.time, at.calls

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
