"""Of which release FMUs are, and when they were made."""

import os
from datetime import UTC, datetime
from importlib.metadata import version

from .errors import BuildError

DATE = "2026-11-23"
"""Of the release, so that the same sources give the same bytes on any day."""

EARLIEST, LATEST = 315_532_800, 4_354_819_199
"""In s since 1970: the years 1980 to 2107, which the dates in a zip file can tell."""


def tool(library: str) -> str:
    """What made an FMU: this package, with the help of that library if one is named."""
    return f"fmublocks {version('fmublocks')}{library and f' ({library})'}"


def date() -> datetime:
    """When an FMU that is built now was made: the date of the release, or that of the variable SOURCE_DATE_EPOCH.

    Raises:
        BuildError: the variable is no number of seconds that a zip file can tell.
    """
    seconds = os.environ.get("SOURCE_DATE_EPOCH")
    if seconds is None:
        return datetime.fromisoformat(DATE).replace(tzinfo=UTC)
    if not (seconds.isdecimal() and EARLIEST <= int(seconds) <= LATEST):
        raise BuildError(f"SOURCE_DATE_EPOCH = {seconds} is refused; allowed is {EARLIEST} to {LATEST} (s since 1970)")
    return datetime.fromtimestamp(int(seconds), UTC)
