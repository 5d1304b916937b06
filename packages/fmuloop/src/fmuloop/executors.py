"""Many runs on an executor of `concurrent.futures`, so on a Dask cluster too."""

import asyncio
import gc
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from contextlib import contextmanager
from importlib.metadata import version
from multiprocessing.util import Finalize
from pickle import loads
from threading import local
from typing import Any
from uuid import uuid4

from cloudpickle import dumps  # pyright: ignore[reportUnknownVariableType]

from toolground.collected_warnings import warn_once
from toolground.errors import UserError
from toolground.optional_packages import required
from toolground.plain_text import plain

from .runs import KeptLoops, kept_by
from .workers import answered_by, collect_warnings

TIMEOUT = 10.0
"""Seconds in which the scheduler of a cluster must answer."""

MOST_UNDER_WAY = 64
"""Batches that are submitted at a time: twice the threads of a cluster of 32."""


@contextmanager
def dask_executor(address: str | None) -> Iterator[Executor | None]:
    """That of a Dask cluster, by the address of its scheduler; None for None.

    Raises:
        UserError: no scheduler answers there.
        MissingExtra: the package distributed is not installed.
    """
    if address is None:
        yield None
        return
    distributed = required("distributed", "a Dask cluster", "fmuloop[cluster]")
    try:
        with ThreadPoolExecutor(1) as pool:  # a notebook has an event loop of its own in this thread
            pool.submit(lambda: asyncio.run(_knock(address))).result()
    except TimeoutError as reason:
        raise UserError(f"no Dask scheduler answers at {address!r} within {TIMEOUT:g} s") from reason
    except (OSError, ValueError) as reason:
        raise UserError(f"no Dask scheduler answers at {address!r}: {plain(reason)}") from reason
    with distributed.Client(address, timeout=TIMEOUT, set_as_default=False) as client:
        if not client.scheduler_info()["workers"]:
            warn_once(f"the scheduler at {address} has no workers yet; the cases wait for them")
        yield client.get_executor()


async def _knock(address: str) -> None:
    """Raises TimeoutError where nothing answers, or what takes the connection says nothing; a client waits for ever."""
    from distributed.comm.core import connect  # pyright: ignore[reportUnknownVariableType]

    async with asyncio.timeout(TIMEOUT):
        await (await connect(address, timeout=TIMEOUT)).close()


def submitting(function: Callable[[Any], Any], executor: Executor) -> Callable[[Sequence[Any]], "Future[Any]"]:
    """What submits a batch of cases and gives the future of what `answered_by` gives for them."""
    sent = uuid4().hex, version("fmuloop"), dumps(function)

    def submit(batch: Sequence[Any]) -> "Future[Any]":
        try:
            return executor.submit(_answer, *sent, dumps(batch))
        except BrokenExecutor as loss:
            future: Future[Any] = Future()
            future.set_exception(loss)
            return future

    return submit


def losses() -> tuple[type[Exception], ...]:
    """What is raised where a case ended its process each time."""
    try:
        from distributed import KilledWorker
    except ImportError:
        return (BrokenExecutor,)
    return BrokenExecutor, KilledWorker


class _Thread(local):
    """What a thread of a worker keeps from one batch to the next: the function, and its systems of FMUs loaded."""

    def __init__(self) -> None:
        self.name = ""
        self.function: Any = None
        self.loops = KeptLoops(None)
        Finalize(self.loops, self.loops.close, exitpriority=1)


_here = _Thread()


def _answer(name: str, expected: str, function: bytes, batch: bytes) -> Any:
    """On a worker.

    Args:
        name: of the function, which another call has not.
        expected: the version of this package.
        function, batch: as cloudpickle has them.
    """
    if _here.name != name:
        if (here := version("fmuloop")) != expected:
            raise UserError(f"a worker has fmuloop {here}, and {expected} is needed")
        collect_warnings()
        _here.loops.close()
        _here.name, _here.function = name, loads(function)
        gc.freeze()  # the garbage of all that is imported is looked for again and again else
    with kept_by(_here.loops):
        return answered_by(_here.function, loads(batch))
