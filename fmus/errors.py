"""What the user of the build can mend."""


class BuildError(Exception):
    """What was asked for cannot be built; the text says why."""


class ParameterFileError(BuildError):
    """A file with parameters is refused; the text names the lines and says what is allowed."""
