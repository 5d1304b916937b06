"""Progress of what takes long, on a terminal or in a notebook."""

import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from contextvars import ContextVar
from importlib.util import find_spec
from time import monotonic

QUIET = 1.0
"""Seconds that a run may take in silence."""

_hidden = ContextVar("hidden", default=False)
"""Each thread has its own."""


def chunks(length: int, size: int = 200) -> Iterator[range]:
    """range(length) in pieces between which progress can be shown."""
    for k in range(0, length, size):
        yield range(k, min(k + size, length))


@contextmanager
def progress(total: int, label: str) -> Iterator[Callable[[int], None]]:
    """What is called with the number of pieces that are done shows them on stderr, from the first second on.

    Within it nothing else shows progress.
    """
    silent, began, show = _hidden.get() or not _visible(), monotonic(), None
    with hidden(), ExitStack() as stack:

        def done(count: int) -> None:
            nonlocal show
            if show is None and not silent and monotonic() - began > QUIET:
                show = stack.enter_context(_bar(total, label))
            if show:
                show(count)

        yield done


@contextmanager
def hidden(wanted: bool = True) -> Iterator[None]:
    """Within it nothing shows progress, if that is wanted."""
    outer = _hidden.set(_hidden.get() or wanted)
    try:
        yield
    finally:
        _hidden.reset(outer)


def _visible() -> bool:
    in_notebook = "ipykernel" in sys.modules and find_spec("ipywidgets") is not None
    return in_notebook or (sys.stderr is not None and sys.stderr.isatty())


@contextmanager
def _bar(total: int, label: str) -> Iterator[Callable[[int], None]]:
    from rich.console import Console  # only a long run needs it
    from rich.progress import Progress

    with Progress(console=Console(file=sys.stderr), transient=True) as bar:
        task = bar.add_task(label, total=total)
        yield lambda count: bar.update(task, completed=count)
