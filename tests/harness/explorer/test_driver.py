"""The thread that runs what tabs ask for."""

from threading import Event
from threading import enumerate as threads

from harness.explorer.driver import Driver


def test_only_the_latest_of_what_a_tab_asks_for_is_done_and_tabs_take_turns() -> None:
    driver, begun, go, done = Driver(), Event(), Event(), []
    ended = Event()

    def first() -> None:
        begun.set()
        go.wait(10.0)

    driver.ask("a", first)
    assert begun.wait(10.0)
    for k in range(5):
        driver.ask("a", lambda k=k: done.append(("a", k)))
        driver.ask("b", lambda k=k: done.append(("b", k)))
    driver.ask("c", ended.set)
    go.set()
    assert ended.wait(10.0)
    driver.close()
    assert done == [("a", 4), ("b", 4)]


def test_nothing_is_done_for_a_tab_that_has_gone_and_no_thread_is_left() -> None:
    driver, begun, go, done = Driver(), Event(), Event(), []

    def first() -> None:
        begun.set()
        go.wait(10.0)

    driver.ask("a", first)
    assert begun.wait(10.0)
    driver.ask("b", lambda: done.append("b"))
    driver.forget("b")
    driver.forget("b")
    go.set()
    driver.close()
    assert done == []
    assert "driver" not in [thread.name for thread in threads()]
