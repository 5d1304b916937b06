"""Progress of what takes long, on a terminal, in a notebook or in a log."""

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from contextvars import ContextVar
from datetime import timedelta
from functools import partial
from html import escape
from math import inf
from threading import Event, Thread
from time import monotonic
from typing import Any, TextIO

from .interruption import uninterrupted_children
from .plain_text import plain
from .status_line import is_terminal

QUIET = 1.0
"""Seconds that a run may take in silence."""

REFRESH = 0.1
"""Seconds between two looks."""

LEAST_PAUSE, MOST_PAUSE = 5.0, 60.0
"""Seconds between two lines where there is no terminal, the first and the later ones; each pause is twice the last."""


def chunks(length: int, size: int = 200) -> Iterator[range]:
    """range(length) in pieces between which progress can be shown."""
    for k in range(0, length, size):
        yield range(k, min(k + size, length))


@contextmanager
def progress(total: int, label: str) -> Iterator[Callable[[float], None]]:
    """What is called with the number of pieces that are done shows the share and the time that is left, from the first
    second on: as a bar on a terminal or in a notebook, else as a line on stderr now and then.

    Args:
        label: in words, or the name of a file of anybody.

    Within it nothing else shows progress, but what is a part of it, see `part`.
    """
    outer, label = _outer.get(), plain(label)
    with hidden(), ExitStack() as stack:
        if outer is not None:
            show = partial(_pass_on, outer, total)
        elif _in_notebook():
            show = stack.enter_context(_of_notebook(total, label))
        elif sys.stderr is not None:
            show = stack.enter_context(_of_stderr(total, label))
        else:
            show = _nowhere

        yield show


@contextmanager
def part(done: Callable[[float], None], first: float, pieces: float = 1.0) -> Iterator[None]:
    """Within it what shows progress fills so many pieces of what `done` shows, from the first on."""
    outer = _outer.set(lambda share: done(first + pieces * share))
    try:
        yield
    finally:
        _outer.reset(outer)


@contextmanager
def hidden(enabled: bool = True) -> Iterator[None]:
    """Within it nothing shows progress, if that is enabled."""
    outer = _outer.set(_nowhere if enabled else _outer.get())
    try:
        yield
    finally:
        _outer.reset(outer)


def _nowhere(_: float) -> None:
    pass


def _pass_on(outer: Callable[[float], None], total: int, count: float) -> None:
    outer(count / max(total, 1))


_outer: ContextVar[Callable[[float], None] | None] = ContextVar("outer", default=None)
"""Where the share goes of what is part of something else; None: to people. Each thread has its own."""


def _in_notebook() -> bool:
    """Whether this process is the kernel of one."""
    ipython: Any = sys.modules.get("IPython")
    return ipython is not None and hasattr(ipython.get_ipython(), "kernel")


@contextmanager
def _of_stderr(total: int, label: str) -> Iterator[Callable[[float], None]]:
    counts, ended = [0.0], Event()
    thread = Thread(target=_attend, args=(total, label, counts, ended, sys.stderr), daemon=True)
    with uninterrupted_children():
        thread.start()
    try:
        yield partial(counts.__setitem__, 0)
    finally:
        ended.set()
        thread.join()


def _attend(total: int, label: str, counts: Sequence[float], ended: Event, shown: TextIO) -> None:
    """Shows the count until it is ended, whether it changes or not, where stderr was when it began."""
    if ended.wait(QUIET):
        return
    from rich import markup  # only a long run needs it
    from rich.console import Console
    from rich.progress import Progress

    animated = is_terminal(shown)
    console = Console(file=shown)
    with Progress(console=console, transient=True, speed_estimate_period=inf, disable=not animated) as bar:
        bar.add_task(markup.escape(label), total=total)
        (task,) = bar.tasks
        pause, due = LEAST_PAUSE, monotonic() + LEAST_PAUSE
        while True:
            bar.update(task.id, completed=counts[0])
            if not animated and monotonic() >= due:
                remaining = "" if task.time_remaining is None else f", {timedelta(seconds=task.time_remaining)} left"
                print(f"{label}: {task.percentage:.0f} %{remaining}", file=shown, flush=True)
                pause = min(2.0 * pause, MOST_PAUSE)
                due = monotonic() + pause
            if ended.wait(REFRESH):
                return


@contextmanager
def _of_notebook(total: int, label: str) -> Iterator[Callable[[float], None]]:
    """Below the cell, with no more than every notebook can show: the bar of rich needs widgets there."""
    from IPython.display import DisplayHandle

    line, next_time, there = DisplayHandle(), monotonic() + QUIET, False

    def show(count: float) -> None:
        nonlocal next_time, there
        if monotonic() >= next_time or (there and count == total):
            if not there:
                line.display({"text/plain": label}, raw=True)
                there = True
            text = f"{label}: {count:g} of {total}"
            bar = f'{escape(label)} <progress value="{count:g}" max="{total}"></progress> {count:g} of {total}'
            line.update({"text/plain": text, "text/html": bar}, raw=True)
            next_time = monotonic() + REFRESH

    try:
        yield show
    finally:
        if there:
            line.update({"text/plain": ""}, raw=True)
