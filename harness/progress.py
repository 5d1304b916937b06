"""Progress of long runs, on a terminal only."""

import sys
from collections.abc import Iterator
from time import monotonic

QUIET = 1.0
"""Seconds that a run may take in silence."""


def chunks(length: int, label: str, size: int = 200) -> Iterator[range]:
    """range(length) in pieces, shown on stderr as progress if it takes longer than a second."""
    pieces = (range(k, min(k + size, length)) for k in range(0, length, size))
    if not sys.stderr.isatty():
        yield from pieces
        return
    # here and not above: importing them takes as long as a short run
    from rich.console import Console
    from rich.progress import Progress

    began = monotonic()
    with Progress(console=Console(file=sys.stderr), transient=True) as bar:
        task = bar.add_task(label, total=length, visible=False)
        for piece in pieces:
            yield piece
            bar.update(task, completed=piece.stop, visible=monotonic() - began > QUIET)
