"""What FMUs that are not ours may take."""

from dataclasses import dataclass
from numbers import Real

from toolground.file_limits import UNPACKED
from toolground.plain_text import plain

from .errors import WiringError


@dataclass(frozen=True)
class Limits:
    """What FMUs that are not ours may take.

    Attributes:
        call: seconds that a call may last.
        unpacked: bytes that an archive may unpack to.

    Raises:
        WiringError: one is no number above 0.
    """

    call: float = 60.0
    unpacked: int = UNPACKED

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if not (isinstance(value, Real) and float(value) > 0.0):
                raise WiringError(f"Limits, {name} = {plain(repr(value), 60)}: it must be a number above 0")


USUAL_LIMITS = Limits()
"""The limits that hold by default."""
