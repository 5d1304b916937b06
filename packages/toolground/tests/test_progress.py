"""Progress is for people who wait: on a terminal, after a while, one at a time."""

import io
import sys
import time
from contextlib import redirect_stderr
from threading import Event, Thread
from threading import enumerate as threads
from types import SimpleNamespace

import pytest

from toolground.progress import chunks, hidden, part, progress


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.fixture(autouse=True)
def time_does_not_matter(monkeypatch):
    for name in ("QUIET", "LEAST_PAUSE", "MOST_PAUSE", "REFRESH"):
        monkeypatch.setattr(f"toolground.progress.{name}", 0.001)
    monkeypatch.setenv("TERM", "xterm")


def eventually(shown, text):
    """Waits until it is written."""
    end = time.monotonic() + 30.0
    while text not in shown.getvalue():
        assert time.monotonic() < end, shown.getvalue()
        time.sleep(0.001)


def make(label, steps=2):
    with progress(steps, label) as done:
        for step in range(steps):
            done(step + 1)


def test_pieces_cover_everything_once():
    assert [*map(list, chunks(5, 2))] == [[0, 1], [2, 3], [4]]
    assert list(chunks(0)) == []


def test_a_long_run_shows_its_share_and_the_time_left_on_a_terminal_before_its_first_piece_is_done():
    with redirect_stderr(Terminal()) as shown, progress(4, "tip-in") as done:
        eventually(shown, "tip-in")
        eventually(shown, "0%")
        eventually(shown, "-:--:--")
        done(1)
        eventually(shown, "25%")
        done(2)
        eventually(shown, "0:00:0")


def test_what_is_said_within_it_elsewhere_is_not_mixed_with_its_lines():
    with redirect_stderr(io.StringIO()) as shown, progress(4, "tip-in"), redirect_stderr(io.StringIO()) as other:
        eventually(shown, "tip-in")
    assert other.getvalue() == ""


@pytest.mark.parametrize("terminal", ["xterm", "dumb"])
def test_the_name_of_a_file_is_shown_as_it_is_but_for_what_a_terminal_obeys(terminal, monkeypatch):
    monkeypatch.setenv("TERM", terminal)
    with redirect_stderr(Terminal()) as shown, progress(2, "a[/b]\x1b]0;c") as done:
        done(1)
        eventually(shown, "a[/b] ]0;c")
        eventually(shown, "50")


def test_nothing_is_left_of_it():
    before = set(threads())
    with redirect_stderr(Terminal()) as shown, progress(2, "tip-in"):
        eventually(shown, "tip-in")
    assert "\x1b[2K" in shown.getvalue()[-20:]  # its line is erased
    for thread in set(threads()) - before:
        thread.join(10.0)  # rich tells its thread to end and does not wait for it
        assert not thread.is_alive()


def test_a_short_run_is_not_shown(monkeypatch):
    monkeypatch.setattr("toolground.progress.QUIET", 3600.0)
    for stream in (Terminal(), io.StringIO()):
        with redirect_stderr(stream) as shown:
            make("tip-in")
        assert shown.getvalue() == ""


def test_who_has_no_stderr_gets_no_progress():
    with redirect_stderr(None):
        make("tip-in")


@pytest.mark.parametrize("stream", [io.StringIO, Terminal])
def test_a_log_gets_a_line_now_and_then(stream, monkeypatch):
    monkeypatch.setenv("TERM", "dumb")
    with redirect_stderr(stream()) as written, progress(4, "tip-in") as done:
        eventually(written, "tip-in: 0 %\n")
        done(1)
        eventually(written, "tip-in: 25 %")
        done(2)
        eventually(written, "tip-in: 50 %, 0:00:0")  # hours, minutes, seconds
        eventually(written, " left\n")
    assert "\x1b" not in written.getvalue()
    assert "\r" not in written.getvalue()


def test_a_log_is_not_flooded(monkeypatch):
    monkeypatch.setattr("toolground.progress.LEAST_PAUSE", 3600.0)
    with redirect_stderr(io.StringIO()) as written:
        make("tip-in", steps=10000)
    assert written.getvalue() == ""


def test_a_part_fills_its_share():
    shares = []
    with part(shares.append, 2.0, 3.0):
        make("rides")
        make("none", steps=0)
    assert shares == [3.5, 5.0]


def test_parts_of_parts_add_up():
    shares = []
    with part(shares.append, 0.0, 8.0), progress(2, "drives") as done, part(done, 1.0):
        make("drive", steps=4)
    assert shares == [5.0, 6.0, 7.0, 8.0]


def test_nothing_shows_the_parts_of_what_is_hidden():
    with redirect_stderr(Terminal()) as shown, hidden(), progress(2, "drives") as done, part(done, 1.0):
        make("drive")
    assert shown.getvalue() == ""


def test_only_the_outer_one_is_shown():
    with redirect_stderr(Terminal()) as shown, progress(2, "cases") as done:
        for number in (1, 2):
            make("tip-in")
            done(number)
        eventually(shown, "cases")
    assert "tip-in" not in shown.getvalue()
    with redirect_stderr(Terminal()) as shown, progress(2, "tip-in"):
        eventually(shown, "tip-in")


def test_an_error_ends_the_display():
    def fail():
        with progress(2, "first") as done:
            done(1)
            raise KeyError

    with redirect_stderr(Terminal()) as shown:
        with pytest.raises(KeyError) as _kept:
            fail()
        with progress(2, "second"):
            eventually(shown, "second")


def test_what_is_hidden_is_not_shown():
    with redirect_stderr(Terminal()) as shown:
        with hidden():
            make("first")
        with hidden(False), progress(2, "second"):
            eventually(shown, "second")
        with hidden(), hidden(False):
            make("third")
    assert "first" not in shown.getvalue()
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
        with progress(2, "here"):
            eventually(shown, "here")
        outside.set()
        thread.join()
        with progress(2, "later"):
            eventually(shown, "later")


@pytest.fixture
def kernel(monkeypatch):
    """What the kernel of a notebook has displayed."""
    monkeypatch.setattr("toolground.progress.QUIET", -1.0)
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
    with redirect_stderr(Terminal()) as shown, progress(2, "tip-in"):
        eventually(shown, "tip-in")
    assert kernel == []
