"""What is said once, however many runs and processes come upon it."""

import logging
from functools import cache

LOG = logging.getLogger(__package__)
"""All loggers of the harness are below it."""


@cache
def warn_once(text: str) -> None:
    """Logs a warning, unless it has been logged before."""
    LOG.warning("%s", text)


class Collected(logging.Handler):
    """What is logged in a worker, for the process that waits to log.

    Attributes:
        texts: of the records so far.
    """

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self.texts: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        self.texts.append(record.getMessage())
