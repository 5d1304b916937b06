"""The options of a command that runs FMUs of others."""

from toolground.argument_types import megabytes, seconds
from toolground.arguments import expert, record

from .limits import USUAL_LIMITS, Limits


@record
class ForeignLimits:
    """What FMUs that are not ours may take."""

    time_limit: float = expert(
        USUAL_LIMITS.call,
        "how long a call of an FMU that is given by its path may last (default: %(default)g)",
        seconds,
        metavar="SECONDS",
    )
    unpacked_limit: int = expert(
        USUAL_LIMITS.unpacked,
        f"how much it may unpack to (default: {USUAL_LIMITS.unpacked / 1e6:.0f})",
        megabytes,
        metavar="MB",
    )

    @property
    def limits(self) -> Limits:
        return Limits(self.time_limit, self.unpacked_limit)
