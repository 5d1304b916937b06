"""What the user of a run can mend; the message says what is wrong and what is allowed."""

from toolground.errors import UserError
from toolground.plain_text import plain

LONGEST_LINE = 900
"""Characters of a line that may repeat what a foreign FMU says."""


class WiringError(UserError):
    """FMUs, connections, inputs or parameters that do not fit together, found before the run.

    Each line of the message is printable and not too long, whatever the FMUs say.
    """

    def __init__(self, message: str) -> None:
        super().__init__("\n".join(plain(line, LONGEST_LINE) for line in message.split("\n")))


class SimulationError(UserError):
    """An FMU refused a call; the message names instance, function, time and what the FMU logged."""

    exit_code = 1


class RunEnded(SimulationError):
    """An FMU asked for the end of a run before there was enough of it."""


class UnpackingError(SimulationError):
    """An FMU cannot be unpacked or loaded on this machine: nothing is said of how it would run elsewhere."""


class InstantiationError(SimulationError):
    """An FMU cannot be loaded or instantiated."""


class UnpackedFolderError(InstantiationError):
    """An FMU cannot be, in a folder whose name some cannot take: nothing is said of how it would run in another."""
