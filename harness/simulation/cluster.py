"""Many runs on a Dask cluster in place of the cores of this machine.

The answer to a case is fetched as soon as it is there: a worker that is lost after that takes nothing with it, and what
it had not answered is run again by another one. Every worker needs this package and the files that the cases read, at
the same paths.
"""

import asyncio
import gc
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError, Future, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from importlib.metadata import version
from pathlib import Path
from pickle import loads
from threading import Lock, local
from typing import Any
from uuid import uuid4

from cloudpickle import dumps
from distributed import Client, KilledWorker, Worker, WorkerPlugin, get_worker
from distributed.comm.core import connect

from ..base.collected_warnings import warn_once
from ..base.errors import DrivelineError, SimulationError
from ..base.plain_text import plain
from ..cosimulation.runs import KeptLoops, kept_by
from .side_by_side import BatchedRuns
from .workers import answered_by, collect_warnings

Lost = KilledWorker
"""Is raised where worker after worker ended while it ran a case."""

TIMEOUT = 10.0
"""Seconds in which the scheduler must answer."""

MOST_UNDER_WAY = 64
"""Batches that are sent at a time, unless the cluster has more than half as many threads."""


@contextmanager
def on_cluster(
    function: Callable[[Any], Any] | BatchedRuns, address: str
) -> Iterator[tuple[Callable[[Sequence[Any]], "Future[Any]"], int]]:
    """What submits a batch of cases and gives the future of what `answered_by` gives for them, and how many batches
    should be under way.

    Args:
        function: of a case; its systems of FMUs stay loaded on the workers.
        address: of the scheduler.

    Raises:
        DrivelineError: no scheduler answers there, or a worker has another version of the package.
    """
    with _connected(address) as client:
        name = f"driveline-{uuid4().hex}"
        try:
            client.register_plugin(Runner(function, version("driveline-damping")), name=name)
        except Exception as refusal:
            raise DrivelineError(f"a worker of {address} cannot be used: {refusal}") from refusal
        threads: Any = client.nthreads()
        most = max(MOST_UNDER_WAY, 2 * sum(threads.values()))
        pool = ThreadPoolExecutor(most)
        try:
            yield lambda batch: pool.submit(_result, client, name, address, batch), most
        finally:
            pool.shutdown(wait=False, cancel_futures=True)
            with suppress(OSError):  # the scheduler may have gone
                client.unregister_worker_plugin(name)


@contextmanager
def _connected(address: str) -> Iterator[Client]:
    try:
        with ThreadPoolExecutor(1) as pool:  # a notebook has an event loop of its own in this thread
            pool.submit(lambda: asyncio.run(_knock(address))).result()  # a client complains long after
    except TimeoutError as reason:
        raise DrivelineError(f"no Dask scheduler answers at {address!r} within {TIMEOUT:g} s") from reason
    except (OSError, ValueError) as reason:
        raise DrivelineError(f"no Dask scheduler answers at {address!r}: {plain(reason)}") from reason
    with Client(address, timeout=TIMEOUT, set_as_default=False) as client:
        if not client.scheduler_info()["workers"]:
            warn_once(f"the scheduler at {address} has no workers yet; the cases wait for them")
        yield client


async def _knock(address: str) -> None:
    """
    Raises:
        TimeoutError: nothing answers, or only takes the connection and says nothing.
    """
    async with asyncio.timeout(TIMEOUT):
        await (await connect(address, timeout=TIMEOUT)).close()


def _result(client: Client, name: str, address: str, batch: Sequence[Any]) -> Any:
    """Of one batch. The thread that waits for it fetches it at once, before its worker can be lost."""
    try:
        return client.submit(_run, dumps(batch), runner=name, pure=False).result()
    except CancelledError as reason:
        raise SimulationError(f"the Dask scheduler at {address} has gone") from reason


def _run(batch: bytes, runner: str) -> Any:
    """On a worker: what its plugin of that name makes of cases."""
    plugin: Any = get_worker().plugins[runner]
    return plugin.answer(loads(batch))


class Runner(WorkerPlugin):
    """On a worker: answers cases; each thread keeps its systems of FMUs loaded.

    Args:
        function: of a case.
        expected: the version of the package.
    """

    def __init__(self, function: Callable[[Any], Any] | BatchedRuns, expected: str) -> None:
        self._sent = dumps(function)
        self._expected = expected

    def setup(self, worker: Worker) -> None:
        if (here := version("driveline-damping")) != self._expected:
            raise DrivelineError(f"it has driveline-damping {here}, and {self._expected} is needed")
        collect_warnings()
        self._function = loads(self._sent)
        self._folder = Path(worker.local_directory)
        self._threads: list[Thread] = []
        self._here = local()
        self._ended = False
        gc.freeze()  # the garbage of all that is imported is looked for again and again else

    def answer(self, batch: Sequence[Any]) -> Any:
        """In one of the threads of the worker."""
        if not hasattr(self._here, "thread"):
            self._here.thread = Thread(self._folder)
            self._threads.append(self._here.thread)
        thread: Thread = self._here.thread
        with thread.busy:
            with kept_by(thread.loops):
                answer = answered_by(self._function, batch)
            if self._ended:
                thread.loops.close()
            return answer

    def teardown(self, worker: Worker) -> None:
        """Unloads what no thread uses; what is used is unloaded when its case has been answered."""
        self._ended = True
        for thread in self._threads:
            if thread.busy.acquire(blocking=False):
                thread.loops.close()
                thread.busy.release()


class Thread:
    """What a thread of a worker has: its loops, and a lock that it holds while it uses them."""

    def __init__(self, folder: Path) -> None:
        self.loops = KeptLoops(folder)
        self.busy = Lock()
