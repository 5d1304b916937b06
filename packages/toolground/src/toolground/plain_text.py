"""Texts of strangers and of the system, as they may stand in a message: one line, no control characters, not too
long."""

import re

LONGEST = 500
"""Characters of a text that are shown."""


def plain(text: object, longest: int = LONGEST) -> str:
    """The text in one line, without what a terminal would obey."""
    line = str(text)
    if not line.isprintable() or "  " in line or line[:1] == " " or line[-1:] == " ":
        line = " ".join("".join(sign if sign.isprintable() else " " for sign in line).split())
    return line if len(line) <= longest else f"{line[:longest]} ... ({len(line)} characters)"


def reason(error: BaseException) -> str:
    """What an error says, in words; one of the operating system without its number, after the file that it names."""
    if not isinstance(error, OSError) or error.strerror is None:
        return plain(error)
    return plain(error.strerror if error.filename is None else f"{error.filename}: {error.strerror}")


def quoted(text: object) -> str:
    """A value that somebody gave, as a message repeats it."""
    return repr(plain(text, 60))


def words(error: BaseException) -> str:
    """An error in words, even one that cannot be printed."""
    try:
        text = str(error)
    except Exception:
        text = ""
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


def printed(unit: str) -> str:
    """A unit as tables, figures and pages have it: N·m and m/s³ for the N.m and m/s3 of FMI and of files."""
    raised = str.maketrans("23456789", "²³⁴⁵⁶⁷⁸⁹")
    return re.sub(r"(?<=[A-Za-z)])\^?[2-9]", lambda power: power[0][-1].translate(raised), unit.replace(".", "·"))
