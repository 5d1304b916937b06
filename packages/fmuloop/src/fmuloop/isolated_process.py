"""An isolated process for FMUs that are not ours: one that exits, crashes or hangs there is a message here.

A question is a function and its arguments, pickled; the answer is plain data. Whatever FMUs print is thrown away, and
nothing they do reaches the process that asks.
"""

import pickle
from collections.abc import Callable, Sequence
from math import isfinite
from mmap import mmap
from pathlib import Path
from time import monotonic
from typing import Any, BinaryIO

from toolground.child_process import POLL, signal_name
from toolground.interpreter import Interpreter
from toolground.progress import hidden

from .call_trace import AT_START, FUNCTIONS, CallRecord, rest, share
from .errors import InstantiationError, SimulationError, UnpackedFolderError
from .process_answers import Answer, Bytes, InvalidAnswer, receive, send

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
        self._was_killed = self._has_invalid = False
        self._process = Interpreter(_answer_questions, folder)
        self.folder = self._process.folder
        page = self.folder / "call_trace"
        page.write_bytes(bytes(PAGE))
        with page.open("r+b") as file:
            self._memory = mmap(file.fileno(), PAGE)
        self._process.send(pickle.dumps(page))

    def ask(self, function: Callable[..., Any], *arguments: Any) -> list[str]:
        """The texts that a function, one that can be imported, answers in the process; none for None.

        Raises:
            SimulationError: an FMU has ended the process, or a call lasts too long; of no more use then.
            UnpackedFolderError: an FMU cannot be instantiated, and the folder has a name that some cannot take.
            Exception: what the function raised, if it is one of `process_answers.ERRORS`.
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
        try:
            self._process.send(pickle.dumps((function, arguments), pickle.HIGHEST_PROTOCOL))
            answer = receive(self._attentive(watch), size)
        except (InvalidAnswer, EOFError) as end:
            self._has_invalid = isinstance(end, InvalidAnswer)
            self._end(0.0 if self._has_invalid else PATIENCE)
            raise SimulationError(self._ended()) from None
        except BaseException:
            self._end()  # an answer that comes later would be taken for that to the next question
            raise
        if answer.error is not None:
            raise answer.error
        return answer

    def _attentive(self, watch: Callable[[float], None] | None) -> Callable[[int], bytearray]:
        """What reads so many bytes of an answer, and meanwhile looks at where the FMUs are."""
        seen, since = self._at(), monotonic()

        def read(size: int) -> bytearray:
            nonlocal seen, since
            while True:
                try:
                    return self._process.read(size, POLL)
                except TimeoutError:
                    now = self._at()
                if now != seen:
                    seen, since = now, monotonic()
                elif now[1] and monotonic() - since > self._longest_call:
                    raise SimulationError(f"{self._call('did not return from')} within {self._longest_call:g} s")
                if watch and now[2] >= 0.0:
                    watch(now[2])

        return read

    def close(self) -> None:
        """Ends it and removes its files."""
        self._end(PATIENCE)

    @property
    def alive(self) -> bool:
        return self._process.alive

    def _end(self, patience: float = 0.0) -> None:
        self._was_killed |= not self._process.end(patience)

    def _ended(self) -> str:
        if self._has_invalid:
            return self._call("wrote among the answers of the process that it ran in, in")
        if self._was_killed:
            return self._call("gave no more answers and was ended, in")
        code = self._process.process.returncode
        if code >= 0:
            return self._call(f"ended the process that it ran in, with exit code {code}, in")
        return self._call(f"crashed ({signal_name(-code)}) in")

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


# what follows runs in the other process


def _answer_questions(questions: BinaryIO, answers: BinaryIO) -> None:
    """Answers until nobody asks any more; first it is told where its calls are noted."""
    with pickle.load(questions).open("r+b") as page:
        share(mmap(page.fileno(), 0))
    while True:
        try:
            function, arguments = pickle.load(questions)
        except EOFError:
            return
        answer = _answer(function, arguments)
        rest()  # writing the answer may take longer than a call may
        send(answer, answers)


def _answer(function: Callable[..., Any], arguments: tuple[Any, ...]) -> Answer:
    try:
        with hidden():
            value = function(*arguments)
    except Exception as error:
        return Answer(error=error)
    return Answer(content=value) if isinstance(value, Bytes) else Answer(texts=value or ())
