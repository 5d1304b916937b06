"""What the user of the build can mend."""

from toolground.errors import UserError


class BuildError(UserError):
    """What was asked for cannot be built; the text says why."""


class NotPossible(BuildError):
    """Something that a build needs is missing; the text says what."""
