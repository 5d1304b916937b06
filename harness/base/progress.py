"""Progress of what takes long, on a terminal or in a notebook."""

import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from contextvars import ContextVar
from html import escape
from time import monotonic
from typing import Any

from .interruption import end_if_abandoned

QUIET = 1.0
"""Seconds that a run may take in silence."""

REFRESH = 0.1
"""Seconds between two looks of a notebook."""

_hidden = ContextVar("hidden", default=False)
"""Each thread has its own."""


def chunks(length: int, size: int = 200) -> Iterator[range]:
    """range(length) in pieces between which progress can be shown."""
    for k in range(0, length, size):
        yield range(k, min(k + size, length))


@contextmanager
def progress(total: int, label: str) -> Iterator[Callable[[int], None]]:
    """What is called with the number of pieces that are done shows them on stderr or in the notebook, from the first
    second on.

    Within it nothing else shows progress.
    """
    silent, began, show = _hidden.get() or not _visible(), monotonic(), None
    with hidden(), ExitStack() as stack:

        def done(count: int) -> None:
            nonlocal show
            end_if_abandoned()
            if show is None and not silent and monotonic() - began > QUIET:
                bar = _line_of_notebook if _in_notebook() else _bar
                show = stack.enter_context(bar(total, label))
            if show:
                show(count)

        yield done


@contextmanager
def hidden(enabled: bool = True) -> Iterator[None]:
    """Within it nothing shows progress, if that is enabled."""
    outer = _hidden.set(_hidden.get() or enabled)
    try:
        yield
    finally:
        _hidden.reset(outer)


def _visible() -> bool:
    return _in_notebook() or (sys.stderr is not None and sys.stderr.isatty())


def _in_notebook() -> bool:
    """Whether this process is the kernel of one."""
    ipython: Any = sys.modules.get("IPython")
    return ipython is not None and hasattr(ipython.get_ipython(), "kernel")


@contextmanager
def _bar(total: int, label: str) -> Iterator[Callable[[int], None]]:
    from rich.console import Console  # only a long run needs it
    from rich.progress import Progress

    with Progress(console=Console(file=sys.stderr), transient=True) as bar:
        task = bar.add_task(label, total=total)
        yield lambda count: bar.update(task, completed=count)


@contextmanager
def _line_of_notebook(total: int, label: str) -> Iterator[Callable[[int], None]]:
    """Below the cell, with no more than every notebook can show: the bar of rich needs widgets there."""
    from IPython.display import DisplayHandle

    line, next_time = DisplayHandle(), 0.0
    line.display({"text/plain": label}, raw=True)

    def show(count: int) -> None:
        nonlocal next_time
        if monotonic() >= next_time or count == total:
            text = f"{label}: {count} of {total}"
            bar = f'{escape(label)} <progress value="{count}" max="{total}"></progress> {count} of {total}'
            line.update({"text/plain": text, "text/html": bar}, raw=True)
            next_time = monotonic() + REFRESH

    try:
        yield show
    finally:
        line.update({"text/plain": ""}, raw=True)
