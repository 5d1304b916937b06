"""Warnings that are logged once, however many runs and processes meet them."""

import logging
from functools import cache

LOG = logging.getLogger(__name__.partition(".")[0])
"""All loggers of the package are below it."""


@cache
def warn_once(text: str) -> None:
    """Logs a warning, unless it has been logged before."""
    LOG.warning("%s", text)


class CollectedWarnings(logging.Handler):
    """Collects the warnings of a worker, for the process that waits to log.

    Attributes:
        texts: of the records so far.
    """

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self.texts: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        self.texts.append(record.getMessage())
