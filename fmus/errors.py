"""What the user of the build can mend."""

import os
from errno import ENOSPC
from tempfile import gettempdir


class BuildError(Exception):
    """What was asked for cannot be built; the text says why."""


class NotPossible(BuildError):
    """Something that a build needs is missing; the text says what."""


class ParameterFileError(BuildError):
    """A file with parameters is refused; the text names the lines and says what is allowed."""


class NoSuchCar(ParameterFileError):
    """Entries of a car disagree or are out of bounds, or no car has them all; the text says why.

    Args:
        text: what is wrong.
        entries: names of those that it is about, the first of them that stands in a file first.
    """

    def __init__(self, text: str, *entries: str) -> None:
        super().__init__(text)
        self.entries = entries


def full_disk() -> OSError:
    """That there is no room for temporary files."""
    return OSError(ENOSPC, os.strerror(ENOSPC), f"temporary files in {gettempdir()}")
