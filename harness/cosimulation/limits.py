"""What FMUs that are not ours may take."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Limits:
    """What FMUs that are not ours may take.

    Attributes:
        call: seconds that a call may last.
        unpacked: bytes that an archive may unpack to.
    """

    call: float = 60.0
    unpacked: int = 10**9


USUAL = Limits()
"""The limits that hold by default."""
