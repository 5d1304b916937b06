"""Whether a recorded drive can be true, told before it is driven and after."""

import logging
from collections.abc import Sequence
from os import PathLike

from driverecords.drive import Drive
from driverecords.findings import Finding
from driverecords.plausibility import not_followed
from driverecords.source import RecordingError

from ...loop import roles
from .replay import Ride

LOG = logging.getLogger(__name__)


def followed_speed(drive: Drive, rides: Sequence[Ride]) -> list[Finding]:
    """What the ride without damping, the first one, says against the recording; nothing if an FMU has ended it."""
    signals = rides[0].signals
    return [] if signals.ended else not_followed(drive, signals["time"], signals[roles.BODY_SPEED])


def tell(findings: Sequence[Finding], recording: PathLike[str] | str, strict: bool = False) -> None:
    """Logs what is odd in a recording, a warning each.

    Raises:
        RecordingError: something is, and it is strict.
    """
    for finding in findings:
        LOG.warning("%s: %s", recording, finding)
    if findings and strict:
        names = ", ".join(dict.fromkeys(finding.rule.name for finding in findings))
        raise RecordingError(f"{recording} is not plausible ({names}), which --strict refuses")
