"""Warnings that are logged once, however many runs and processes meet them."""

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache

LOG = logging.getLogger(__name__.partition(".")[0])
"""All loggers of the package are below it."""


_silent: ContextVar[bool] = ContextVar("silent", default=False)


@cache
def warn_once(text: str) -> None:
    """Logs a warning, unless it has been logged before."""
    if not _silent.get():
        LOG.warning("%s", text)


@contextmanager
def as_if_logged(silent: bool) -> Iterator[None]:
    """Within it, if `silent`, what is to be warned of once counts as logged, also if a worker says it later."""
    before = _silent.set(silent)
    try:
        yield
    finally:
        _silent.reset(before)


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
