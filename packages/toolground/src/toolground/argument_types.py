"""What words of a command line are read as, each with its check: paths, numbers, times."""

from argparse import ArgumentTypeError
from collections.abc import Callable
from math import ceil, isfinite
from pathlib import Path
from tempfile import TemporaryFile

from .plain_text import quoted
from .written_numbers import real, whole


def _path(text: str, what: str, other: str, wrong: Callable[[Path], bool]) -> Path:
    if not text:
        raise ArgumentTypeError(f"the name of the {what} is empty")
    try:
        if wrong(Path(text)):
            raise ArgumentTypeError(f"{text} is a {other}; a {what} is needed")
    except OSError as error:  # a name that is too long
        raise ArgumentTypeError(error.strerror or str(error)) from error
    return Path(text)


def folder(text: str) -> Path:
    """The path of a folder, which may not exist yet."""
    return _path(text, "folder", "file", lambda path: path.exists() and not path.is_dir())


def file(text: str) -> Path:
    """The path of a file, which may not exist yet."""
    return _path(text, "file", "folder", Path.is_dir)


def output_folder(text: str) -> Path:
    """The path of a folder that can be written to, or made; tried here, before anything takes long."""
    path = folder(text)
    _require_writable(text, path.absolute())
    return path


def output_file(text: str) -> Path:
    """The path of a file in such a folder."""
    path = file(text)
    _require_writable(text, path.absolute().parent)
    return path


def _require_writable(text: str, there: Path) -> None:
    try:
        while not there.exists():
            there = there.parent
        TemporaryFile(dir=there).close()
    except OSError as error:
        raise ArgumentTypeError(f"{text} cannot be written to: {there}: {error.strerror}") from error


def number(takes: Callable[[float], bool], what: str) -> Callable[[str], float]:
    """What takes a number, and says what it must be."""

    def parsed(text: str) -> float:
        found = real(text)
        if found is None or not takes(found):
            raise ArgumentTypeError(f"{quoted(text)} is not {what}")
        return found

    return parsed


seconds = number(lambda x: isfinite(x) and x > 0.0, "a time above 0 s")
finite = number(isfinite, "a finite number")
share = number(lambda x: 0.0 <= x <= 1.0, "a number from 0 to 1")


def amount(text: str) -> float:
    """A finite number that is 0 or more."""
    if (found := finite(text)) < 0.0:
        raise ArgumentTypeError(f"{quoted(text)} is below 0")
    return found


def megabytes(text: str) -> int:
    """A size above 0 MB, in bytes; of a part of a byte the whole."""
    return ceil(number(lambda x: isfinite(x * 1e6) and x > 0.0, "a size above 0 MB")(text) * 1e6)


def counted(least: int, most: int) -> Callable[[str], int]:
    """What takes a whole number between these."""

    def parsed(text: str) -> int:
        found = whole(text, len(str(most)))
        if found is None or not least <= found <= most:
            raise ArgumentTypeError(f"{quoted(text)} is not a whole number from {least} to {most}")
        return found

    return parsed


def written(ending: str, what: str) -> Callable[[str], Path]:
    """What takes the name of a file with this ending that can be written to; `what` says what it is."""

    def named(text: str) -> Path:
        if Path(text).suffix != ending:
            raise ArgumentTypeError(f"{quoted(text)}: {what} is a {ending}")
        return output_file(text)

    return named
