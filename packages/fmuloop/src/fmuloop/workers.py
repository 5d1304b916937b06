"""Processes that share cases, and what a process does that has been sent one, here or on a cluster."""

import gc
import logging
import os
import sys
import tempfile
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from pickle import load, loads
from struct import Struct
from threading import local
from traceback import format_exc
from typing import Any, BinaryIO, NamedTuple

from cloudpickle import dumps  # pyright: ignore[reportUnknownVariableType]

from toolground.atomic_files import note_unfinished, remove_unfinished
from toolground.collected_warnings import CollectedWarnings
from toolground.interpreter import Interpreter
from toolground.interruption import uninterrupted_children
from toolground.plain_text import words
from toolground.progress import hidden

from .campaign import outcomes
from .errors import SimulationError
from .row_file import keep_freed
from .runs import kept_loaded

ONE_THREAD = {f"{library}_NUM_THREADS": "1" for library in ("OMP", "OPENBLAS", "MKL")}
"""The environment of a worker: the cores are shared by processes, and threads of linear algebra that wait for each
other take five times what they compute."""

PATIENCE = 5.0
"""Seconds in which a worker must have ended when it is no longer needed."""

LENGTH = Struct("<Q")
"""Of an answer."""


class Lost(Exception):
    """The process of cases has ended before it answered."""


class WorkerTraceback(Exception):
    """Where in the worker an error was raised: the cause of the error here."""


class Workers:
    """New interpreters (FMUs that run Python do not survive a fork), each asked by a thread; one that is lost is
    replaced."""

    def __init__(self, function: Callable[[Any], Any], count: int) -> None:
        """
        Args:
            function: of a case.
            count: how many.
        """
        self._function = dumps(function)
        self._threads = ThreadPoolExecutor(count)
        self._here = local()
        self._begun: list[Interpreter] = []
        self._ended = False

    def submit(self, batch: Sequence[Any]) -> "Future[Any]":
        """The future of what `answered_by` gives for the cases."""
        with uninterrupted_children():
            return self._threads.submit(self._answers, batch)

    def _answers(self, batch: Sequence[Any]) -> Any:
        worker = getattr(self._here, "worker", None)
        if worker is None or worker.closed:
            worker = Interpreter(_answer_cases, environment=ONE_THREAD, stderr=None, tidy=remove_unfinished)
            self._here.worker = worker
            self._begun.append(worker)
            if self._ended:
                worker.end()
            worker.send(self._function)
        worker.send(dumps(batch))
        try:
            answers, error, trace = loads(worker.read(*LENGTH.unpack(worker.read(LENGTH.size))))
        except EOFError:
            worker.end()
            raise Lost from None
        if error is not None:
            raise error from WorkerTraceback(trace)
        return answers

    def end(self, unfinished: bool) -> None:
        """Nothing of them is left.

        Args:
            unfinished: whether they are still at work.
        """
        self._ended = True
        self._threads.shutdown(wait=False, cancel_futures=True)
        for worker in [*self._begun]:
            worker.end(0.0 if unfinished else PATIENCE)
        self._threads.shutdown()


class Submitted(NamedTuple):
    """Cases that a process is given together, and the future of their answers."""

    batch: Sequence[Any]
    future: "Future[Any]"


def in_order(
    submit: Callable[[Sequence[Any]], "Future[Any]"], batches: Iterable[Sequence[Any]], most: int
) -> Iterator[Submitted]:
    """Batches as they are answered, no more than so many of them submitted at a time."""
    waiting: deque[Submitted] = deque()
    for batch in batches:
        waiting.append(Submitted(batch, submit(batch)))
        if len(waiting) >= most:
            yield waiting.popleft()
    while waiting:
        yield waiting.popleft()


_collected = CollectedWarnings()


def _answer_cases(questions: BinaryIO, answers: BinaryIO) -> None:
    """In a worker: systems stay loaded as long as it lives, and only the process that waits shows anything."""
    sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115 (open as long as the process)
    function = load(questions)
    note_unfinished(Path(tempfile.gettempdir()))
    collect_warnings()
    keep_freed()
    gc.freeze()  # the garbage of all that is imported is looked for again and again else
    with kept_loaded():
        while True:
            try:
                batch = load(questions)
            except EOFError:
                return
            answer = _pickled_answer(function, batch)
            answers.write(LENGTH.pack(len(answer)) + answer)
            answers.flush()


def _pickled_answer(function: Callable[[Any], Any], batch: Sequence[Any]) -> bytes:
    """The answers, the error that was raised instead, and where."""
    try:
        return dumps((answered_by(function, batch), None, ""))
    except BaseException as error:
        return dumps((None, error, format_exc()))


def collect_warnings() -> None:
    """In a worker: from now on warnings go with the answers."""
    logging.getLogger().addHandler(_collected)


def answered_by(function: Callable[[Any], Any], batch: Sequence[Any]) -> list[tuple[bytes, list[str]]]:
    """In a worker: the answers as pickle has them and what was warned of, up to a case that raises an error, or whose
    answer cannot be pickled, which is raised if it is the first; what cannot be sent to the process that waits is told
    in words. Where runs of several cases are made together, the first answer has the warnings of all."""
    answers: list[tuple[bytes, list[str]]] = []
    with hidden(), _collected.new() as texts:
        for answer, error in outcomes(function, batch):
            try:
                if error is not None:
                    raise _sendable(error)
                answers.append((_pickled(answer), list(texts)))
            except BaseException:
                if answers:
                    break
                raise
            texts.clear()
    return answers


def _pickled(answer: Any) -> bytes:
    try:
        return dumps(answer)
    except Exception as error:
        kind = type(answer).__name__
        raise SimulationError(f"its answer, a {kind}, cannot be sent to another process: {words(error)}") from None


def _sendable(error: BaseException) -> BaseException:
    """An error, in words if it cannot be sent to another process."""
    if isinstance(error, SystemExit):
        return error
    try:
        loads(dumps(error))
    except Exception:
        return SimulationError(words(error))
    return error
