"""What the user of the build can mend."""

import os
from errno import ENOSPC
from tempfile import gettempdir

from toolground.errors import UserError


class BuildError(UserError):
    """What was asked for cannot be built; the text says why."""


class NotPossible(BuildError):
    """Something that a build needs is missing; the text says what."""


def full_disk() -> OSError:
    """That there is no room for temporary files."""
    return OSError(ENOSPC, os.strerror(ENOSPC), f"temporary files in {gettempdir()}")
