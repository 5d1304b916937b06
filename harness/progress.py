"""Progress of long runs, on a terminal only."""

import sys
from collections.abc import Iterator
from time import monotonic

from rich.console import Console
from rich.progress import Progress

QUIET = 1.0
"""Seconds that a run may take in silence."""


def chunks(length: int, label: str, size: int = 200) -> Iterator[range]:
    """range(length) in pieces, shown on stderr as progress if it takes longer than a second."""
    began = monotonic()
    silent = not sys.stderr.isatty()
    with Progress(console=Console(file=sys.stderr), transient=True, disable=silent) as bar:
        task = bar.add_task(label, total=length, visible=False)
        for k in range(0, length, size):
            piece = range(k, min(k + size, length))
            yield piece
            bar.update(task, completed=piece.stop, visible=monotonic() - began > QUIET)
