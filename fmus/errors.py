"""What the user of the build can mend."""


class BuildError(Exception):
    """What was asked for cannot be built; the text says why."""
