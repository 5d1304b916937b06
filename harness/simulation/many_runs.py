"""Many independent runs on all cores, from a script, a notebook or the command line.

```python
def settling(k_d: float) -> float:
    results = simulate(tipin, "ValidationVehicle", parameters={"controller.k_d": k_d})
    return evaluate(results, tipin).settling_time


times = run_many(settling, np.linspace(0.0, 5.0, 1000))
```
"""

from collections.abc import Callable, Iterable, Iterator, MutableMapping
from concurrent.futures import Future
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from textwrap import shorten
from typing import NoReturn, TypeVar

from ..base.collected_warnings import warn_once
from ..base.errors import DrivelineError, SimulationError
from ..base.optional_packages import required
from ..base.plain_text import words
from ..base.progress import progress
from ..cosimulation.runs import kept_loaded

Case = TypeVar("Case")
Answer = TypeVar("Answer")


def run_many(
    function: Callable[[Case], Answer],
    cases: Iterable[Case],
    workers: int | None = None,
    label: str = "simulating",
    scheduler: str | None = None,
    known: MutableMapping[Case, Answer] | None = None,
) -> list[Answer]:
    """What a function gives for each of the cases, in their order.

    A system of FMUs that the function runs stays loaded for the next case. A case whose process was lost is run once
    more.

    Args:
        workers: processes that share the cases; with 1 it is this process. None: one a core.
        label: of the progress display.
        scheduler: address of that of a Dask cluster, whose workers share the cases then.
        known: answers by cases, which are hashable then. They are not asked for again; those that are missing are
            added, in the order of the cases, each as soon as it is there.

    Raises:
        Exception: what the function raised first in the order of the cases; its message or a note names the case.
        SimulationError: a case ended its process twice.
    """
    require_workers(workers)
    every, answers = list(cases), []
    todo = every if known is None else [case for case in dict.fromkeys(every) if case not in known]
    count = min(workers or _cores(), max(len(todo), 1))
    with many(function, count, scheduler if todo else None) as answered, progress(len(every), label) as done:
        done(len(every) - len(todo))
        for case, answer in zip(todo, answered(todo), strict=True):
            if known is not None:
                known[case] = answer
            answers.append(answer)
            done(len(every) - len(todo) + len(answers))
    return answers if known is None else [known[case] for case in every]


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
    from .workers import Lost, Workers

    with TemporaryDirectory(prefix="driveline-", ignore_cleanup_errors=True) as folder:
        workers = Workers(function, count, Path(folder))

        def answered(cases: Iterable[Case]) -> Iterator[Answer]:
            for case, future in workers.answered(list(cases)):
                yield _gathered(case, future, Lost)

        unfinished = True
        try:
            yield answered
            unfinished = False
        finally:
            workers.end(unfinished)


@contextmanager
def _on_cluster(
    function: Callable[[Case], Answer], scheduler: str
) -> Iterator[Callable[[Iterable[Case]], Iterator[Answer]]]:
    required("distributed", "a Dask cluster", "cluster")
    from .cluster import Lost, on_cluster

    with on_cluster(function, scheduler) as submit:

        def answered(cases: Iterable[Case]) -> Iterator[Answer]:
            todo = list(cases)
            for case, future in zip(todo, [submit(case) for case in todo], strict=True):
                yield _gathered(case, future, Lost)

        yield answered


def _gathered(case: object, future: "Future[tuple[Answer, list[str]]]", loss: type[Exception]) -> Answer:
    """The answer of a worker, whose warnings are logged here.

    Args:
        future: of what `answered_by` gives for the case.
        loss: is raised where the case ended its process each time.
    """
    try:
        answer, warnings = future.result()
    except loss as error:
        raise SimulationError(f"a process crashed in {_text(case)}, and again when that was run once more") from error
    except (Exception, SystemExit) as error:
        _raise(error, case)
    for text in warnings:
        warn_once(text)
    return answer


def _raise(error: BaseException, case: object) -> NoReturn:
    """Raises the error with its case; what would end the process or a generator, as a SimulationError."""
    if isinstance(error, DrivelineError):
        raise type(error)(f"{_text(case)}: {error}") from error
    if isinstance(error, (StopIteration, SystemExit)):
        raise SimulationError(f"{_text(case)}: {words(error)}") from error
    error.add_note(f"in {_text(case)}")
    raise error


def _text(case: object) -> str:
    return f"case {shorten(str(case), 200, placeholder=' ...')}"
