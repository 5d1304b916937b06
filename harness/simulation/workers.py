"""Processes that share cases, and what a process does that has been sent one, here or on a cluster."""

import atexit
import gc
import logging
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future
from contextlib import ExitStack
from multiprocessing import resource_tracker
from pathlib import Path
from pickle import loads
from shutil import rmtree
from typing import Any

from cloudpickle import dumps
from loky import ProcessPoolExecutor
from loky.backend import resource_tracker as lokys_tracker
from loky.process_executor import BrokenProcessPool

from ..base.atomic_files import note_unfinished, remove_unfinished
from ..base.collected_warnings import LOG, CollectedWarnings
from ..base.errors import SimulationError
from ..base.interruption import end_with, uninterrupted_children
from ..base.plain_text import words
from ..base.progress import hidden
from ..cosimulation.runs import kept_loaded

Lost = BrokenProcessPool
"""Is raised where the process of a case was lost."""


class Workers:
    """New interpreters (FMUs that run Python do not survive a fork); one that is lost is replaced.

    Args:
        function: of a case.
        count: how many.
        folder: for what they unpack and note.
    """

    def __init__(self, function: Callable[[Any], Any], count: int, folder: Path) -> None:
        self._count = count
        self._folder = folder
        self._given = folder, function, os.getpid()
        for tracker in (resource_tracker, lokys_tracker):  # beginning the first lets interruptions through again
            with uninterrupted_children():
                tracker.ensure_running()
        self._begin()

    def answered(self, cases: Sequence[Any]) -> Iterator[tuple[Any, "Future[Any]"]]:
        """The cases with their answers, in their order, as of `answered_by`; a case whose process was lost is run once
        more."""
        futures, again = [self._submit(case) for case in cases], -1
        for k, case in enumerate(cases):
            if k > again and _is_lost(futures[k]):
                # The lost process had one of the first cases that are not answered, and nobody tells which. Each of
                # these is run by itself, so that one that ends its process again takes no other with it.
                lost = [j for j in range(k, len(cases)) if _is_lost(futures[j])]
                self._begin_again()
                for again in lost[: self._count]:
                    futures[again] = self._submit(cases[again])
                    if _is_lost(futures[again]):
                        self._begin_again()
                for j in lost[self._count :]:
                    futures[j] = self._submit(cases[j])
            yield case, futures[k]

    def end(self, unfinished: bool) -> None:
        """Nothing of them is left.

        Args:
            unfinished: whether they are still at work.
        """
        self._pool.shutdown(kill_workers=unfinished)
        remove_unfinished(self._folder)

    def _begin(self) -> None:
        self._pool = ProcessPoolExecutor(self._count, initializer=_begin, initargs=self._given)

    def _begin_again(self) -> None:
        """Without one process the others are of no use either."""
        self.end(unfinished=True)
        self._begin()

    def _submit(self, case: Any) -> "Future[Any]":
        try:
            with uninterrupted_children():
                return self._pool.submit(_answer, case)
        except Lost as loss:
            future: Future[Any] = Future()
            future.set_exception(loss)
            return future


def _is_lost(future: "Future[Any]") -> bool:
    """Whether the process of a case was lost; waits for its answer."""
    return isinstance(future.exception(), Lost)


_function: Callable[[Any], Any]
_collected = CollectedWarnings()


def _begin(folder: Path, function: Callable[[Any], Any], waiting: int) -> None:
    """In a worker: systems stay loaded as long as it lives, and only the process that waits shows anything."""
    global _function
    _function = function
    end_with(waiting, tidy=lambda: rmtree(folder, ignore_errors=True))
    note_unfinished(folder)
    collect_warnings().propagate = False
    sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115 (open as long as the process)
    kept = ExitStack()
    kept.enter_context(kept_loaded(folder))
    atexit.register(kept.close)
    gc.freeze()  # loky collects garbage once a second, which takes 0.1 s with all that is imported


def collect_warnings() -> logging.Logger:
    """In a worker: from now on warnings go with the answers."""
    LOG.addHandler(_collected)
    return LOG


def _answer(case: Any) -> tuple[Any, list[str]]:
    return answered_by(_function, case)


def answered_by(function: Callable[[Any], Any], case: Any) -> tuple[Any, list[str]]:
    """In a worker: the answer and what was warned of; what cannot be sent to the process that waits is told in
    words."""
    _collected.texts.clear()
    try:
        with hidden():
            return function(case), list(_collected.texts)
    except SystemExit:
        raise
    except BaseException as error:
        try:
            loads(dumps(error))
        except Exception:
            raise SimulationError(words(error)) from None
        raise
