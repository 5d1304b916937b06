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


def full_disk() -> OSError:
    """That there is no room for temporary files."""
    return OSError(ENOSPC, os.strerror(ENOSPC), f"temporary files in {gettempdir()}")
