"""Whether a recorded drive can be true, told after it is driven."""

from collections.abc import Sequence

from driverecords.drive import Drive
from driverecords.findings import Finding
from driverecords.plausibility import not_followed

from ...loop import roles
from .replay import Ride


def followed_speed(drive: Drive, rides: Sequence[Ride]) -> list[Finding]:
    """What the ride without damping, the first one, says against the recording; nothing if an FMU has ended it."""
    signals = rides[0].signals
    return [] if signals.ended else not_followed(drive, signals["time"], signals[roles.BODY_SPEED])
