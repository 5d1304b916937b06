"""Progress is for people who wait: on a terminal, after a while, one at a time."""

import io
import sys
from contextlib import redirect_stderr
from threading import Event, Thread
from types import SimpleNamespace

import pytest

from driveline.harness.base.progress import chunks, hidden, progress


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.fixture(autouse=True)
def time_does_not_matter(monkeypatch):
    monkeypatch.setattr("driveline.harness.base.progress.QUIET", -1.0)
    monkeypatch.setenv("TERM", "xterm")


def make(label, steps=2):
    with progress(steps, label) as done:
        for step in range(steps):
            done(step + 1)


def test_pieces_cover_everything_once():
    assert [*map(list, chunks(5, 2))] == [[0, 1], [2, 3], [4]]
    assert list(chunks(0)) == []


def test_a_long_run_is_shown_on_a_terminal():
    with redirect_stderr(Terminal()) as shown:
        make("tip-in")
    assert "tip-in" in shown.getvalue()


def test_a_short_run_is_not_shown(monkeypatch):
    monkeypatch.setattr("driveline.harness.base.progress.QUIET", float("inf"))
    with redirect_stderr(Terminal()) as shown:
        make("tip-in")
    assert shown.getvalue() == ""


def test_who_has_no_stderr_gets_no_progress():
    with redirect_stderr(None):
        make("tip-in")


def test_a_file_gets_no_progress():
    with redirect_stderr(io.StringIO()) as written:
        make("tip-in")
    assert written.getvalue() == ""


def test_only_the_outer_one_is_shown():
    with redirect_stderr(Terminal()) as shown, progress(2, "cases") as done:
        for number in (1, 2):
            make("tip-in")
            done(number)
    assert "cases" in shown.getvalue()
    assert "tip-in" not in shown.getvalue()
    with redirect_stderr(Terminal()) as shown:
        make("tip-in")
    assert "tip-in" in shown.getvalue()


def test_an_error_ends_the_display():
    def fail():
        with progress(2, "first") as done:
            done(1)
            raise KeyError

    with redirect_stderr(Terminal()) as shown:
        with pytest.raises(KeyError) as _kept:
            fail()
        make("second")
    assert "second" in shown.getvalue()


def test_what_is_hidden_is_not_shown():
    with redirect_stderr(Terminal()) as shown:
        with hidden():
            make("first")
        with hidden(False):
            make("second")
        with hidden(), hidden(False):
            make("third")
    assert "first" not in shown.getvalue()
    assert "second" in shown.getvalue()
    assert "third" not in shown.getvalue()


def test_threads_do_not_hide_each_others_progress():
    inside, outside = Event(), Event()

    def hide():
        with hidden():
            inside.set()
            outside.wait(10.0)

    thread = Thread(target=hide)
    thread.start()
    inside.wait(10.0)
    with redirect_stderr(Terminal()) as shown:
        make("here")
        outside.set()
        thread.join()
        make("later")
    assert "here" in shown.getvalue()
    assert "later" in shown.getvalue()


@pytest.fixture
def kernel(monkeypatch):
    """What the kernel of a notebook has displayed."""
    display = pytest.importorskip("IPython.display", reason="needs the extra `notebook`")
    displayed = []

    class Handle:
        def display(self, data, raw):
            displayed.append(data)

        update = display

    monkeypatch.setattr(display, "DisplayHandle", Handle)
    monkeypatch.setattr(sys.modules["IPython"], "get_ipython", lambda: SimpleNamespace(kernel=None))
    return displayed


def test_a_notebook_shows_how_far_it_is_and_nothing_when_all_is_done(kernel):
    with redirect_stderr(io.StringIO()) as written:
        make("tip-in <1>")
    assert [data["text/plain"] for data in kernel] == ["tip-in <1>", "tip-in <1>: 1 of 2", "tip-in <1>: 2 of 2", ""]
    assert kernel[2]["text/html"] == 'tip-in &lt;1&gt; <progress value="2" max="2"></progress> 2 of 2'
    assert written.getvalue() == ""


def test_a_notebook_is_not_flooded(kernel):
    make("tip-in", steps=10000)
    assert len(kernel) < 100
    assert kernel[-2]["text/plain"] == "tip-in: 10000 of 10000"


def test_a_shell_of_ipython_is_a_terminal(kernel, monkeypatch):
    monkeypatch.setattr(sys.modules["IPython"], "get_ipython", SimpleNamespace)
    with redirect_stderr(Terminal()) as shown:
        make("tip-in")
    assert "tip-in" in shown.getvalue()
    assert kernel == []
