"""A command never leaves a terminal dark: a line says that it is at work whenever nothing else is shown."""

import io
import sys
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout, suppress
from threading import Event

import pytest

from toolground import status_line
from toolground.status_line import Line, waiting


class Terminal(io.StringIO):
    """Notes when it is said for the first time that something is at work."""

    def __init__(self) -> None:
        super().__init__()
        self.wrote = Event()

    def isatty(self) -> bool:
        return True

    def write(self, text: str) -> int:
        written = super().write(text)
        if "at work" in text:
            self.wrote.set()
        return written

    def seen(self) -> str:
        """What stands on the screen: each line from where the cursor last went back to its margin and erased it."""
        return "\n".join(line.rpartition("\r")[2].replace("\x1b[K", "") for line in self.getvalue().split("\n"))


@pytest.fixture(autouse=True)
def time_does_not_matter(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(status_line, "QUIET", -1.0)
    monkeypatch.setattr(status_line, "INTERVAL", 0.001)
    monkeypatch.setenv("TERM", "xterm")


@contextmanager
def terminal() -> Iterator[Terminal]:
    with redirect_stderr(Terminal()) as shown, redirect_stdout(shown):
        yield shown


def test_a_silent_command_is_said_to_be_at_work_and_leaves_nothing() -> None:
    with terminal() as shown, waiting("driveline compare"):
        assert shown.wrote.wait(60.0)
        assert "driveline compare: at work" in shown.seen()
    assert shown.seen() == ""


def test_what_is_printed_takes_the_place_of_the_line() -> None:
    with terminal() as shown, waiting("driveline compare"):
        assert shown.wrote.wait(60.0)
        print("a result")
        print("what goes wrong", file=sys.stderr)
    assert shown.seen() == "a result\nwhat goes wrong\n"


def test_output_that_has_just_come_is_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(status_line, "QUIET", 1e6)
    line = Line(shown := Terminal(), "driveline compare")
    line.beat()
    assert shown.getvalue() == ""


def test_an_unfinished_line_is_left_alone() -> None:
    line = Line(shown := Terminal(), "driveline compare")
    line.give_way("a question? ")
    line.beat()
    assert shown.getvalue() == ""
    line.give_way("\n")
    line.beat()
    assert "at work" in shown.getvalue()


@pytest.mark.parametrize("enabled", [False, True])
def test_who_wants_no_line_or_has_no_terminal_has_the_streams_as_they_are(enabled: bool) -> None:
    shown = io.StringIO() if enabled else Terminal()
    with redirect_stderr(shown), waiting("driveline compare", enabled):
        assert sys.stderr is shown
    assert shown.getvalue() == ""


def test_the_streams_are_those_from_before_afterwards() -> None:
    with terminal() as shown:
        with suppress(KeyboardInterrupt), waiting("driveline compare"):
            assert sys.stdout is not shown
            raise KeyboardInterrupt
        assert sys.stdout is sys.stderr is shown
