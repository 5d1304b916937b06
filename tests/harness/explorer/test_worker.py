"""The thread that runs what tabs ask for."""

from concurrent.futures import Future
from threading import Event
from threading import enumerate as threads
from typing import Any

import pytest

from driveline.harness.base.errors import DrivelineError
from driveline.harness.base.progress import progress
from driveline.harness.explorer.worker import MOST_WAITING, Worker


def test_only_the_latest_of_what_a_tab_asks_for_is_done_and_tabs_take_turns() -> None:
    worker, begun, go, done = Worker(), Event(), Event(), []
    ended = Event()

    def first() -> None:
        begun.set()
        go.wait(10.0)

    worker.ask("a", first)
    assert begun.wait(10.0)
    futures = []
    for k in range(5):
        futures.append(worker.ask("a", lambda k=k: done.append(("a", k))))
        worker.ask("b", lambda k=k: done.append(("b", k)))
    worker.ask("c", ended.set)
    go.set()
    assert ended.wait(10.0)
    worker.close()
    assert done == [("a", 4), ("b", 4)]
    assert [future.cancelled() for future in futures] == [True] * 4 + [False]


def test_who_asks_gets_the_answer_or_the_error() -> None:
    worker = Worker()
    assert worker.ask("a", lambda: 7).result(10.0) == 7
    with pytest.raises(ZeroDivisionError):
        worker.ask("a", lambda: 1 / 0).result(10.0)
    worker.close()


def test_nothing_is_done_for_a_tab_that_has_gone_and_no_thread_is_left() -> None:
    worker, begun, go, done = Worker(), Event(), Event(), []

    def first() -> None:
        begun.set()
        go.wait(10.0)

    worker.ask("a", first)
    assert begun.wait(10.0)
    forgotten = worker.ask("b", lambda: done.append("b"))
    worker.forget("b")
    worker.forget("b")
    assert forgotten.cancelled()
    go.set()
    worker.close()
    assert done == []
    assert "worker" not in [thread.name for thread in threads()]


def endless(worker: Worker, asker: str) -> "Future[Any]":
    """Has a run begun that never ends by itself."""
    begun = Event()

    def run() -> None:
        with progress(1, "run") as done:
            while True:
                begun.set()
                done(0)

    future = worker.ask(asker, run)
    assert begun.wait(10.0)
    return future


def test_a_run_under_way_ends_with_the_server() -> None:
    worker = Worker()
    future = endless(worker, "a")
    worker.close()
    assert future.cancelled()
    assert "worker" not in [thread.name for thread in threads()]


def test_a_run_under_way_ends_with_its_tab_and_the_next_one_is_made() -> None:
    worker, ended = Worker(), Event()

    def run() -> None:
        with progress(1, "run") as done:
            done(1)
        ended.set()

    endless(worker, "a")
    worker.forget("a")
    worker.ask("b", run)
    assert ended.wait(10.0)
    worker.close()


def test_no_more_wait_than_there_may_be() -> None:
    worker, begun, go = Worker(), Event(), Event()

    def first() -> None:
        begun.set()
        go.wait(10.0)

    worker.ask("first", first)
    assert begun.wait(10.0)
    for asker in range(MOST_WAITING):
        worker.ask(asker, int)
    worker.ask(0, int)
    with pytest.raises(DrivelineError, match=f"^{MOST_WAITING} requests wait"):
        worker.ask("one more", int)
    worker.forget(0)
    worker.ask("one more", int)
    go.set()
    worker.close()
