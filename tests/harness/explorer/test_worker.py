"""The thread that runs what tabs ask for."""

from threading import Event
from threading import enumerate as threads

from driveline.harness.explorer.worker import Worker


def test_only_the_latest_of_what_a_tab_asks_for_is_done_and_tabs_take_turns() -> None:
    worker, begun, go, done = Worker(), Event(), Event(), []
    ended = Event()

    def first() -> None:
        begun.set()
        go.wait(10.0)

    worker.ask("a", first)
    assert begun.wait(10.0)
    for k in range(5):
        worker.ask("a", lambda k=k: done.append(("a", k)))
        worker.ask("b", lambda k=k: done.append(("b", k)))
    worker.ask("c", ended.set)
    go.set()
    assert ended.wait(10.0)
    worker.close()
    assert done == [("a", 4), ("b", 4)]


def test_nothing_is_done_for_a_tab_that_has_gone_and_no_thread_is_left() -> None:
    worker, begun, go, done = Worker(), Event(), Event(), []

    def first() -> None:
        begun.set()
        go.wait(10.0)

    worker.ask("a", first)
    assert begun.wait(10.0)
    worker.ask("b", lambda: done.append("b"))
    worker.forget("b")
    worker.forget("b")
    go.set()
    worker.close()
    assert done == []
    assert "worker" not in [thread.name for thread in threads()]
