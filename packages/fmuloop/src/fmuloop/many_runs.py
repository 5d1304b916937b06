"""Many independent runs on all cores, from a script, a notebook or the command line.

```python
def settling(k_d: float) -> float:
    results = simulate(tipin, "ValidationVehicle", parameters={"controller.k_d": k_d})
    return evaluate(results, tipin).settling_time


times = run_many(settling, np.linspace(0.0, 5.0, 1000))
```

Where cases say beforehand which runs they need, and judge their results, runs that are alike are made together:

```python
def needed(k_d: float) -> list[RunRequest]:
    return [planned(tipin, "ValidationVehicle", parameters={"controller.k_d": k_d})]


def settling(k_d: float, results: Sequence[Results]) -> float:
    return evaluate(results[0], tipin).settling_time


times = run_many(settling, np.linspace(0.0, 5.0, 1000), runs=needed)
```
"""

import os
from collections.abc import Callable, Iterable, Iterator, MutableMapping, Sequence
from concurrent.futures import CancelledError, Executor, Future, wait
from contextlib import AbstractContextManager, contextmanager, suppress
from pathlib import Path
from pickle import loads
from textwrap import shorten
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar

from toolground.collected_warnings import warn_once
from toolground.errors import UserError
from toolground.lanes_here import lanes_here
from toolground.plain_text import words
from toolground.progress import progress

from .campaign import MANY, Campaign, RunRequest, batched, outcomes
from .errors import SimulationError
from .runs import kept_loaded

if TYPE_CHECKING:
    from .workers import Submitted

AHEAD = 4
"""Batches a process that are submitted at a time, the one at work among them."""

HEEDING = 0.2
"""Seconds between two looks for signals while answers are waited for."""

QUOTA = Path("/sys/fs/cgroup/cpu.max")
"""Of a container: how much of a period it may compute on all cores together; "max" is no limit (cgroups, version 2)."""

Case = TypeVar("Case")
Answer = TypeVar("Answer")


def run_many(
    function: Callable[..., Answer],
    cases: Iterable[Case],
    workers: int | None = None,
    label: str = "simulating",
    executor: Executor | None = None,
    known: MutableMapping[Case, Answer] | None = None,
    batch: int = 1,
    runs: Callable[[Case], Sequence[RunRequest]] | None = None,
) -> list[Answer]:
    """What a function gives for each of the cases, in their order.

    A system of FMUs that the function runs stays loaded for the next case. A case whose process was lost is run once
    more.

    Args:
        function: of a case; with `runs` it judges, of a case and the results of its runs: a sequence, which raises the
            error of a run where that is taken.
        workers: processes that share the cases; with 1 it is this process. None: one a core.
        label: of the progress display.
        executor: of `concurrent.futures`, which runs the cases then: `client.get_executor()` of a Dask client.
        known: answers by cases, which are hashable then. They are not asked for again; those that are missing are
            added, in the order of the cases, each as soon as it is there.
        batch: cases that a worker is given at a time; more where many are brief and workers are far.
        runs: gives those that a case needs. Of 32 cases and more (MANY), and wherever answers are `known`, which must
            not depend on how many are asked for at once, runs of the same native FMUs of the project are made side by
            side in the lanes of the processor then. They differ from single runs by the rounding of single operations.

    Raises:
        Exception: what the function raised first in the order of the cases; its message or a note names the case.
        SimulationError: a case ended its process twice.
    """
    require_workers(workers)
    every, answers = list(cases), []
    todo = every if known is None else [case for case in dict.fromkeys(every) if case not in known]
    count = min(workers or cores(), max(len(todo), 1))
    _require_batch(batch)
    work = _campaign(function, runs, len(every) if known is None else MANY)
    if _is_in_lanes(work):
        batch = max(batch, min(MANY, -(-len(todo) // count)))
    with _many(work, count, executor, batch) as answered, progress(len(every), label) as done:
        done(len(every) - len(todo))
        for case, answer in zip(todo, answered(todo), strict=True):
            if known is not None:
                known[case] = answer
            answers.append(answer)
            done(len(every) - len(todo) + len(answers))
    return answers if known is None else [known[case] for case in every]


@contextmanager
def many(
    function: Callable[..., Answer],
    workers: int | None = None,
    executor: Executor | None = None,
    batch: int = 1,
    runs: Callable[[Case], Sequence[RunRequest]] | None = None,
) -> Iterator[Callable[[Iterable[Case]], Iterator[Answer]]]:
    """What gives the answers for cases, in their order, and can be asked again: processes and FMUs stay loaded.

        with driveline.many(settling) as answers:
            for time in answers(case for case in range(10_000_000)):

    Cases are asked for a few ahead of the answers, and neither are kept: ten million take the memory of a hundred.

    The runs of `runs` are made in lanes where batches are of MANY. Args and errors as of `run_many`.
    """
    require_workers(workers)
    _require_batch(batch)
    with _many(_campaign(function, runs, batch), workers or cores(), executor, batch) as answered:
        yield answered


def _campaign(
    function: Callable[..., Answer], runs: Callable[[Case], Sequence[RunRequest]] | None, cases: int
) -> Callable[[Case], Answer]:
    """What answers a case."""
    return Campaign(runs, function, cases >= MANY and lanes_here() > 0) if runs else function


def _is_in_lanes(work: Callable[[Any], Any]) -> bool:
    return isinstance(work, Campaign) and work.in_lanes


def _many(
    work: Callable[[Case], Answer], count: int, executor: Executor | None, batch: int
) -> AbstractContextManager[Callable[[Iterable[Case]], Iterator[Answer]]]:
    if executor is not None:
        return _on_executor(work, executor, batch)
    return _here(work, batch if _is_in_lanes(work) else 1) if count == 1 else _in_workers(work, count, batch)


def _require_batch(batch: int) -> None:
    if not (isinstance(batch, int) and batch >= 1):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise UserError(f"batch = {batch!r}: it must be a whole number from 1 on")


def require_workers(workers: int | None) -> None:
    """Refuses a number of workers that is none."""
    if workers is not None and not (isinstance(workers, int) and workers >= 1):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise UserError(f"workers = {workers!r}: it must be a whole number from 1 on, or None")


def cores() -> int:
    """That this process may use; a container has a share of the time of all."""
    number = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    with suppress(OSError, ValueError):
        quota, period = map(int, QUOTA.read_text(encoding="ascii").split())
        number = min(number, -(-quota // period))
    return number


@contextmanager
def _here(function: Callable[[Case], Answer], batch: int) -> Iterator[Callable[[Iterable[Case]], Iterator[Answer]]]:
    def answered(cases: Iterable[Case]) -> Iterator[Answer]:
        for part in batched(cases, batch):
            for case, (answer, error) in zip(part, outcomes(function, part), strict=True):
                if isinstance(error, (Exception, SystemExit)):
                    _raise(error, case)
                if error is not None:
                    raise error
                yield answer

    with kept_loaded():
        yield answered


@contextmanager
def _in_workers(
    function: Callable[[Case], Answer], count: int, batch: int
) -> Iterator[Callable[[Iterable[Case]], Iterator[Answer]]]:
    from .workers import Lost, Workers, in_order

    workers = Workers(function, count)

    def answered(cases: Iterable[Case]) -> Iterator[Answer]:
        for each in in_order(workers.submit, batched(cases, batch), AHEAD * count):
            yield from _gathered(each, workers.submit, Lost)

    unfinished = True
    try:
        yield answered
        unfinished = False
    finally:
        workers.end(unfinished)


@contextmanager
def _on_executor(
    function: Callable[[Case], Answer], executor: Executor, batch: int
) -> Iterator[Callable[[Iterable[Case]], Iterator[Answer]]]:
    from .executors import MOST_UNDER_WAY, losses, submitting
    from .workers import in_order

    submit = submitting(function, executor)

    def answered(cases: Iterable[Case]) -> Iterator[Answer]:
        for each in in_order(submit, batched(cases, batch), MOST_UNDER_WAY):
            yield from _gathered(each, submit, losses())

    yield answered


def _gathered(
    submitted: "Submitted",
    submit: "Callable[[Sequence[Any]], Future[Any]]",
    loss: type[Exception] | tuple[type[Exception], ...],
    again: bool = False,
) -> Iterator[Any]:
    """The answers of a worker, whose warnings are logged here.

    Args:
        submitted: cases, and the future of what `answered_by` gives for them.
        submit: what is left of them, where one raised an error or ended its process.
        loss: is raised where the cases ended their process.
        again: whether they did before.
    """
    batch, future = submitted.batch, submitted.future
    while batch:
        while not future.done():  # a signal that another thread has got is heeded when this one wakes up
            wait([future], HEEDING)
        try:
            answers = future.result()
        except loss as error:
            if again:
                text = f"a process crashed in {_text(batch[0])}, and again when that was run once more"
                raise SimulationError(text) from error
            for case in batch:
                yield from _gathered(submitted._replace(batch=[case], future=submit([case])), submit, loss, again=True)
            return
        except CancelledError as error:
            raise SimulationError(f"what runs the cases has gone before {_text(batch[0])}") from error
        except (Exception, SystemExit) as error:
            _raise(error, batch[0])
        for case, (answer, warnings) in zip(batch, answers, strict=False):
            for text in warnings:
                warn_once(text)
            yield _received(answer, case)
        if batch := batch[len(answers) :]:
            future = submit(batch)


def _received(answer: bytes, case: object) -> Any:
    try:
        return loads(answer)
    except Exception as error:
        raise SimulationError(f"{_text(case)}: its answer cannot be read from its worker: {words(error)}") from error


def _raise(error: BaseException, case: object) -> NoReturn:
    """Raises the error with its case; what would end the process or a generator, as a SimulationError."""
    if isinstance(error, UserError):
        raise type(error)(f"{_text(case)}: {error}") from error
    if isinstance(error, (StopIteration, SystemExit)):
        raise SimulationError(f"{_text(case)}: {words(error)}") from error
    error.add_note(f"in {_text(case)}")
    raise error


def _text(case: object) -> str:
    return f"case {shorten(str(case), 200, placeholder=' ...')}"
