"""Processes that share cases, and what a process does that has been sent one, here or on a cluster."""

import atexit
import gc
import logging
import os
import sys
import tempfile
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future
from contextlib import ExitStack
from itertools import accumulate
from multiprocessing import resource_tracker
from pathlib import Path
from pickle import loads
from shutil import rmtree
from typing import Any, NamedTuple

from cloudpickle import dumps  # pyright: ignore[reportUnknownVariableType]
from loky import ProcessPoolExecutor
from loky.backend import resource_tracker as lokys_tracker
from loky.process_executor import BrokenProcessPool

from toolground.atomic_files import note_unfinished, remove_unfinished
from toolground.collected_warnings import CollectedWarnings
from toolground.interruption import end_with, uninterrupted_children
from toolground.plain_text import words
from toolground.progress import hidden

from .errors import SimulationError
from .row_file import keep_freed
from .runs import kept_loaded
from .side_by_side import BatchedRuns, outcomes

Lost = BrokenProcessPool
"""Is raised where the process of a case was lost."""


ONE_THREAD = {f"{library}_NUM_THREADS": "1" for library in ("OMP", "OPENBLAS", "MKL")}
"""The environment of a worker: the cores are shared by processes, and threads of linear algebra that wait for each
other take five times what they compute."""


class Workers:
    """New interpreters (FMUs that run Python do not survive a fork); one that is lost is replaced.

    Args:
        function: of a case.
        count: how many.
        folder: for what they unpack and note, and for all their temporary files; who gives it removes it.
    """

    def __init__(self, function: Callable[[Any], Any] | BatchedRuns, count: int, folder: Path) -> None:
        self._count = count
        self._folder = folder
        self._given = folder, function, os.getpid()
        for tracker in (resource_tracker, lokys_tracker):  # beginning the first lets interruptions through again
            with uninterrupted_children():
                tracker.ensure_running()
        self._begin()

    def submit(self, batch: Sequence[Any]) -> "Future[Any]":
        """The future of what `answered_by` gives for the cases."""
        try:
            with uninterrupted_children():
                return self._pool.submit(_answer, batch)
        except Lost as loss:
            future: Future[Any] = Future()
            future.set_exception(loss)
            return future

    def submit_alone(self, batch: Sequence[Any]) -> "Future[Any]":
        """As `submit`; if another case has ended its process meanwhile, once more with no other beside it."""
        future = self.submit(batch)
        if not _is_lost(future):
            return future
        self._begin_again()
        return self.submit(batch)

    def mend(self, waiting: "deque[Submitted]") -> None:
        """Runs once more what was lost with a process, if the first batch was.

        The lost process had one of the first batches that are not answered, and nobody tells which. Each case of these
        is run by itself, so that one that ends its process again takes no other with it.
        """
        if waiting[0].again or not _is_lost(waiting[0].future):
            return
        lost = [_is_lost(submitted.future) and not submitted.again for submitted in waiting]
        self._begin_again()
        mended: list[Submitted] = []
        for submitted, is_lost, before in zip(waiting, lost, accumulate(lost), strict=True):
            suspected = is_lost and before <= self._count
            mended += map(self._by_itself, submitted.batch) if suspected else [submitted]
        waiting.clear()
        for submitted in mended:
            is_lost_again = not submitted.again and _is_lost(submitted.future)
            waiting.append(submitted._replace(future=self.submit(submitted.batch)) if is_lost_again else submitted)

    def _by_itself(self, case: Any) -> "Submitted":
        alone = Submitted([case], self.submit([case]), again=True)
        if _is_lost(alone.future):
            self._begin_again()
        return alone

    def end(self, unfinished: bool) -> None:
        """Nothing of them is left.

        Args:
            unfinished: whether they are still at work.
        """
        self._pool.shutdown(kill_workers=unfinished)
        remove_unfinished(self._folder)

    def _begin(self) -> None:
        with uninterrupted_children():  # else a lock that is being made would be left
            self._pool = ProcessPoolExecutor(self._count, initializer=_begin, initargs=self._given, env=ONE_THREAD)

    def _begin_again(self) -> None:
        """Without one process the others are of no use either."""
        self.end(unfinished=True)
        self._begin()


class Submitted(NamedTuple):
    """Cases that a process is given together, and the future of their answers.

    Attributes:
        again: they were lost once.
    """

    batch: Sequence[Any]
    future: "Future[Any]"
    again: bool = False


def in_order(
    submit: Callable[[Sequence[Any]], "Future[Any]"],
    batches: Iterable[Sequence[Any]],
    most: int,
    mend: Callable[["deque[Submitted]"], None] = lambda _: None,
) -> Iterator[Submitted]:
    """Batches as they are answered, no more than so many of them submitted at a time; `mend` may replace some before
    the first is waited for."""
    waiting: deque[Submitted] = deque()
    for batch in batches:
        waiting.append(Submitted(batch, submit(batch)))
        if len(waiting) >= most:
            mend(waiting)
            yield waiting.popleft()
    while waiting:
        mend(waiting)
        yield waiting.popleft()


def _is_lost(future: "Future[Any]") -> bool:
    """Whether the process of a case was lost; waits for its answer."""
    return isinstance(future.exception(), Lost)


_function: Callable[[Any], Any] | BatchedRuns
_collected = CollectedWarnings()


def _begin(folder: Path, function: Callable[[Any], Any] | BatchedRuns, waiting: int) -> None:
    """In a worker: systems stay loaded as long as it lives, and only the process that waits shows anything."""
    global _function
    _function = function
    end_with(waiting, tidy=lambda: rmtree(folder, ignore_errors=True))
    note_unfinished(folder)
    tempfile.tempdir = str(folder)  # a worker that is killed while a compiler runs removes nothing itself
    collect_warnings()
    sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115 (open as long as the process)
    kept = ExitStack()
    kept.enter_context(kept_loaded(folder))
    atexit.register(kept.close)
    keep_freed()
    gc.freeze()  # loky collects garbage once a second, which takes 0.1 s with all that is imported


def collect_warnings() -> None:
    """In a worker: from now on warnings go with the answers."""
    logging.getLogger().addHandler(_collected)


def _answer(batch: Sequence[Any]) -> list[tuple[bytes, list[str]]]:
    return answered_by(_function, batch)


def answered_by(function: Callable[[Any], Any] | BatchedRuns, batch: Sequence[Any]) -> list[tuple[bytes, list[str]]]:
    """In a worker: the answers as pickle has them and what was warned of, up to a case that raises an error, or whose
    answer cannot be pickled, which is raised if it is the first; what cannot be sent to the process that waits is told
    in words. Where cases are answered side by side, the first answer has the warnings of all."""
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
