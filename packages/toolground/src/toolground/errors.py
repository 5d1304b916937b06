"""What the user can mend; the message says what is wrong and what is allowed."""

import os
from errno import ENOSPC
from tempfile import gettempdir


class UserError(Exception):
    """Base of all errors that the user can mend; a command line prints them without a traceback.

    Attributes:
        exit_code: of the command that meets it.
    """

    exit_code = 2


class MissingExtra(UserError):
    """A package of an optional extra is not installed; the message names the extra."""


def full_disk() -> OSError:
    """That there is no room for temporary files."""
    return OSError(ENOSPC, os.strerror(ENOSPC), f"temporary files in {gettempdir()}")
