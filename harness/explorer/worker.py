"""A thread that runs what tabs ask for, each time the latest, so that none waits for an outdated request."""

from collections.abc import Callable, Hashable
from concurrent.futures import Future, ThreadPoolExecutor
from contextvars import copy_context
from threading import Condition, Thread
from typing import Any

from ..base.errors import DrivelineError
from ..base.interruption import Abandoned, abandonable
from ..base.progress import hidden
from ..cosimulation.runs import KeptLoops, kept_by

Job = Callable[[], Any]

MOST_WAITING = 20
"""Askers whose jobs have not begun: ten tabs, each with a run and a file to save."""

Asked = tuple[Job, "Future[Any]"]


class Beside:
    """A thread for what is done while another thread does something else; systems stay loaded in it too."""

    def __init__(self) -> None:
        self._loops = KeptLoops(None)
        self._thread = ThreadPoolExecutor(1, "beside")

    def begin(self, job: Job) -> Job:
        """What waits for the job and gives what it gives; it is abandoned as what the thread does that asks."""
        return self._thread.submit(copy_context().run, self._do, job).result

    def close(self) -> None:
        """Waits for what has begun, and ends the thread."""
        self._thread.submit(self._loops.close)
        self._thread.shutdown()

    def _do(self, job: Job) -> Any:
        with kept_by(self._loops):
            return job()


class Worker:
    """Systems stay loaded in it. A job that has not begun when the same asker asks again is forgotten; askers take
    turns."""

    def __init__(self) -> None:
        self._asked: dict[Hashable, Asked] = {}
        self._asker: Hashable = None  # whose job is under way
        self._abandoned = False  # that job
        self._changed = Condition()
        self._open = True
        self._thread = Thread(target=self._work, name="worker", daemon=True)
        self._thread.start()

    def ask(self, asker: Hashable, job: Job) -> "Future[Any]":
        """The future of what a job gives; cancelled if it is forgotten.

        Raises:
            DrivelineError: too many wait.
        """
        future: Future[Any] = Future()
        with self._changed:
            self._drop(asker)
            if len(self._asked) >= MOST_WAITING:
                raise DrivelineError(f"{MOST_WAITING} requests wait, which is all there may be: close a tab")
            self._asked[asker] = job, future
            self._changed.notify()
        return future

    def forget(self, asker: Hashable) -> None:
        """Nothing more is done for someone who has gone; a run that is under way ends."""
        with self._changed:
            self._drop(asker)
            self._abandoned |= self._asker == asker

    def _drop(self, asker: Hashable) -> None:
        if asker in self._asked:
            self._asked.pop(asker)[1].cancel()

    def close(self) -> None:
        """Ends the thread; a run that is under way ends at once, and a file that is being written is finished."""
        with self._changed:
            self._open = False
            self._abandoned = True
            for asker in list(self._asked):
                self._drop(asker)
            self._changed.notify()
        self._thread.join()

    def _work(self) -> None:
        loops = KeptLoops(None)
        try:
            with kept_by(loops), hidden(), abandonable(lambda: self._abandoned):
                while (asked := self._next()) is not None:
                    job, future = asked
                    try:
                        future.set_result(job())
                    except Abandoned:
                        future.cancel()
                    except Exception as error:
                        future.set_exception(error)
        finally:
            loops.close()

    def _next(self) -> Asked | None:
        with self._changed:
            self._asker = None
            self._changed.wait_for(lambda: self._asked or not self._open)
            if not self._open:
                return None
            self._asker, self._abandoned = next(iter(self._asked)), False
            return self._asked.pop(self._asker)
