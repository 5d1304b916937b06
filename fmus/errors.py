"""What the user can mend; of all that, and of files of cars and controllers."""

from fmublocks.errors import BuildError
from toolground.errors import UserError

DrivelineError = UserError
"""Base of all errors that the user can mend; the command line prints them without a traceback."""


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
