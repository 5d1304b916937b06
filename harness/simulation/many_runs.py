"""Many independent runs on all cores, from a script, a notebook or the command line.

```python
def settling(k_d: float) -> float:
    results = simulate(tipin, "ValidationVehicle", parameters={"controller.k_d": k_d})
    return evaluate(results, tipin).settling_time


times = run_many(settling, np.linspace(0.0, 5.0, 1000))
```
"""

import atexit
import gc
import logging
import os
import sys
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future
from contextlib import ExitStack, contextmanager
from functools import partial
from pathlib import Path
from pickle import loads
from tempfile import TemporaryDirectory
from textwrap import shorten
from typing import Any, NoReturn, TypeVar

from ..base.atomic_files import note_unfinished, remove_unfinished
from ..base.collected_warnings import LOG, CollectedWarnings, warn_once
from ..base.errors import DrivelineError, SimulationError
from ..base.interruption import uninterrupted_children
from ..base.optional_packages import required
from ..base.progress import progress
from ..cosimulation.runs import kept_loaded

Case = TypeVar("Case")
Answer = TypeVar("Answer")


def run_many(
    function: Callable[[Case], Answer], cases: Iterable[Case], workers: int | None = None, label: str = "simulating"
) -> list[Answer]:
    """What a function gives for each of the cases, in their order.

    A system of FMUs that the function runs stays loaded for the next case.

    Args:
        workers: processes that share the cases; with 1 it is this process. None: one a core.
        label: of the progress display.

    Raises:
        Exception: what the function raised first in the order of the cases; its message or a note names the case.
        SimulationError: a worker crashed.
    """
    require_workers(workers)
    todo = list(cases)
    answers = []
    with many(function, min(workers or _cores(), max(len(todo), 1))) as answered, progress(len(todo), label) as done:
        for answer in answered(todo):
            answers.append(answer)
            done(len(answers))
    return answers


@contextmanager
def many(
    function: Callable[[Case], Answer], workers: int | None = None, scheduler: str | None = None
) -> Iterator[Callable[[Iterable[Case]], Iterator[Answer]]]:
    """What gives the answers for cases, in their order, and can be asked again: processes and FMUs stay loaded.

    Args and errors as of `run_many`.

    Args:
        scheduler: address of that of a Dask cluster, whose workers share the cases then.
    """
    require_workers(workers)
    count = workers or _cores()
    if scheduler is not None:
        where = _on_cluster(function, scheduler)
    else:
        where = _here(function) if count == 1 else _in_workers(function, count)
    with where as answered:
        yield answered


def require_workers(workers: int | None) -> None:
    """Refuses a number of workers that is none."""
    if workers is not None and not (isinstance(workers, int) and workers >= 1):
        raise DrivelineError(f"workers = {workers!r}: it must be a whole number from 1 on, or None")


def _cores() -> int:
    from loky import cpu_count  # only those who need processes load it

    return cpu_count()


@contextmanager
def _here(function: Callable[[Case], Answer]) -> Iterator[Callable[[Iterable[Case]], Iterator[Answer]]]:
    def answered(cases: Iterable[Case]) -> Iterator[Answer]:
        for case in cases:
            try:
                answer = function(case)
            except (Exception, SystemExit) as error:
                _raise(error, case)
            yield answer

    with kept_loaded():
        yield answered


@contextmanager
def _in_workers(
    function: Callable[[Case], Answer], count: int
) -> Iterator[Callable[[Iterable[Case]], Iterator[Answer]]]:
    """New interpreters (FMUs that run Python do not survive a fork); nothing of them is left at the end."""
    from multiprocessing import resource_tracker

    from loky import ProcessPoolExecutor
    from loky.backend import resource_tracker as lokys_tracker
    from loky.process_executor import BrokenProcessPool

    with TemporaryDirectory(prefix="driveline-", ignore_cleanup_errors=True) as folder:
        for tracker in (resource_tracker, lokys_tracker):  # beginning the first lets interruptions through again
            with uninterrupted_children():
                tracker.ensure_running()
        pool = ProcessPoolExecutor(count, initializer=_begin, initargs=(Path(folder), function))

        def answered(cases: Iterable[Case]) -> Iterator[Answer]:
            todo = list(cases)
            with uninterrupted_children():
                futures = [pool.submit(_answer, case) for case in todo]
            yield from _gathered(todo, futures, BrokenProcessPool)

        unfinished = True
        try:
            yield answered
            unfinished = False
        finally:
            pool.shutdown(kill_workers=unfinished)
            remove_unfinished(Path(folder))


@contextmanager
def _on_cluster(
    function: Callable[[Case], Answer], scheduler: str
) -> Iterator[Callable[[Iterable[Case]], Iterator[Answer]]]:
    required("distributed", "a Dask cluster", "cluster")
    from .cluster import Lost, on_cluster

    with on_cluster(partial(answered_by, function), scheduler) as submit:

        def answered(cases: Iterable[Case]) -> Iterator[Answer]:
            todo = list(cases)
            yield from _gathered(todo, [submit(case) for case in todo], Lost)

        yield answered


def _gathered(
    cases: Iterable[Case], futures: Iterable["Future[tuple[Answer, list[str]]]"], crash: type[Exception]
) -> Iterator[Answer]:
    """The answers of workers, whose warnings are logged here.

    Args:
        futures: of what `answered_by` gives for the cases.
        crash: is raised where a worker crashed.
    """
    for case, future in zip(cases, futures, strict=True):
        try:
            answer, warnings = future.result()
        except crash as error:
            raise SimulationError(f"a process crashed in {_text(case)} or one of the next cases") from error
        except (Exception, SystemExit) as error:
            _raise(error, case)
        for text in warnings:
            warn_once(text)
        yield answer


_function: Callable[[Any], Any]
_collected = CollectedWarnings()


def _begin(folder: Path, function: Callable[[Any], Any]) -> None:
    """In a worker: systems stay loaded as long as it lives, and only the process that waits shows anything."""
    global _function
    _function = function
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
    """In a worker: the answer and its warnings; what cannot be sent to the process that waits is answered
    in words."""
    from cloudpickle import dumps

    _collected.texts.clear()
    try:
        return function(case), list(_collected.texts)
    except SystemExit:
        raise
    except BaseException as error:
        try:
            loads(dumps(error))
        except Exception:
            raise SimulationError(_words(error)) from None
        raise


def _raise(error: BaseException, case: object) -> NoReturn:
    """Raises the error with its case; what would end the process or a generator, as a SimulationError."""
    if isinstance(error, DrivelineError):
        raise type(error)(f"{_text(case)}: {error}") from error
    if isinstance(error, (StopIteration, SystemExit)):
        raise SimulationError(f"{_text(case)}: {_words(error)}") from error
    error.add_note(f"in {_text(case)}")
    raise error


def _words(error: BaseException) -> str:
    """An error in words, even one that cannot be printed."""
    try:
        text = str(error)
    except Exception:
        text = ""
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


def _text(case: object) -> str:
    return f"case {shorten(str(case), 200, placeholder=' ...')}"
