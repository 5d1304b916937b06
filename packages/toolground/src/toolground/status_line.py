"""A line on the terminal while a command shows nothing else: that it is at work, and for how long.

Within `Console.status` of rich (15.0) a printed line that is longer than the terminal is wide becomes two, and one
without an end, as a question, gets one; and each command would load rich, which takes longer than some commands.
"""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Event, Lock, Thread
from time import monotonic
from typing import Any, TextIO, cast

from .interruption import uninterrupted_children

QUIET = 0.5
"""Seconds without any output after which the line is there."""

INTERVAL = 0.2
"""Seconds from one update to the next."""


class Line:
    """The line on a terminal, gone before anything else is written there."""

    def __init__(self, terminal: TextIO, name: str) -> None:
        """Args:
        name: of what is at work.
        """
        self._terminal = terminal
        self._name = name
        self._began = self._last = monotonic()
        self._there = False
        self._at_margin = True
        self._lock = Lock()

    def beat(self) -> None:
        """Shows the line, or its new time, if nothing was written for a while."""
        with self._lock:
            now = monotonic()
            if self._at_margin and now - self._last > QUIET:
                self._write(f"\r{self._name}: at work, {now - self._began:.1f} s\x1b[K")
                self._there = True

    def give_way(self, text: str) -> None:
        """Makes room for what will be written."""
        if text:
            with self._lock:
                self._remove()
                self._last = monotonic()
                self._at_margin = text.endswith("\n") or "\x1b" in text  # what moves about tidies up

    def end(self) -> None:
        """It is gone."""
        with self._lock:
            self._remove()

    def _remove(self) -> None:
        if self._there:
            self._write("\r\x1b[K")
            self._there = False

    def _write(self, text: str) -> None:
        self._terminal.write(text)
        self._terminal.flush()


class InterruptedStream:
    """A stream before whose output the line gives way."""

    def __init__(self, stream: TextIO, line: Line) -> None:
        self._stream = stream
        self._line = line

    def write(self, text: str) -> int:
        self._line.give_way(text)
        return self._stream.write(text)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


@contextmanager
def waiting(name: str, enabled: bool = True) -> Iterator[None]:
    """Within it the terminal, if stderr is one, shows whenever nothing else does that `name` is at work."""
    streams = sys.stdout, sys.stderr
    if not (enabled and is_terminal(sys.stderr)):
        yield
        return
    line = Line(sys.stderr, name)
    over = Event()
    thread = Thread(target=_attend, args=(line, over), daemon=True)
    sys.stdout, sys.stderr = (cast(TextIO, InterruptedStream(stream, line)) for stream in streams)
    with uninterrupted_children():
        thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()
        line.end()
        sys.stdout, sys.stderr = streams


def is_terminal(stream: TextIO | None) -> bool:
    """Whether what is written to it can be taken back."""
    return stream is not None and stream.isatty() and os.environ.get("TERM") != "dumb"


def _attend(line: Line, over: Event) -> None:
    while not over.wait(INTERVAL):
        line.beat()
