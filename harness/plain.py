"""Texts of strangers, as they may stand in a message: one line, no control characters, not too long."""

LONGEST = 500
"""Characters of a text that are shown."""


def plain(text: object, longest: int = LONGEST) -> str:
    """The text in one line, without what a terminal would obey."""
    line = " ".join("".join(sign if sign.isprintable() else " " for sign in str(text)).split())
    return line if len(line) <= longest else f"{line[:longest]} ... ({len(line)} characters)"


def quoted(text: object) -> str:
    """A value that somebody gave, as a message repeats it."""
    return repr(plain(text, 60))
