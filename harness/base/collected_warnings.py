"""Warnings that are logged once, however many runs and processes meet them."""

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache

LOG = logging.getLogger(__name__.partition(".")[0])
"""All loggers of the package are below it."""


@cache
def warn_once(text: str) -> None:
    """Logs a warning, unless it has been logged before."""
    LOG.warning("%s", text)


class CollectedWarnings(logging.Handler):
    """Collects the warnings of a worker, for the process that waits to log: for each of its threads by itself."""

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self._texts: ContextVar[list[str] | None] = ContextVar("texts", default=None)

    @contextmanager
    def new(self) -> Iterator[list[str]]:
        """The texts of what is logged within it, also by threads that run in a copy of this context."""
        texts: list[str] = []
        before = self._texts.set(texts)
        try:
            yield texts
        finally:
            self._texts.reset(before)

    def emit(self, record: logging.LogRecord) -> None:
        texts = self._texts.get()
        if texts is not None:
            texts.append(record.getMessage())
