"""Names: their words, what to say of one that is not known, and whether they tell plants apart."""

import re
from collections.abc import Iterable
from pathlib import Path
from typing import TypeVar

from ...fmus.names import meant
from .errors import DrivelineError

Named = TypeVar("Named")

WORD = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])|\d")


def words_of(name: str) -> list[str]:
    """The words of a name in small letters, of camel case too; a digit is a word."""
    return [word.lower() for word in WORD.findall(name)]


def nearest(name: str, known: Iterable[str], every: str = "known are") -> str:
    """What to say of an unknown name: the known ones nearest to it, or all of them if none is near.

    For example "did you mean tipin15 or tipin50?" or "known are: drive, creep".

    Args:
        every: words before all of them.
    """
    names = list(known)
    return meant(name, names) or f"{every}: {', '.join(names)}"


class UnknownName(DrivelineError, KeyError):
    """Nothing has this name; the message names what is near."""

    __str__ = DrivelineError.__str__


class ByName(dict[str, Named]):
    """What has names; of one that is not known it says what is near.

    Raises:
        UnknownName: nothing has the name.
    """

    def __missing__(self, name: str) -> Named:
        raise UnknownName(f"{name} is not known; {nearest(str(name), self)}")


def by_name(blocks: Iterable[str], kind: str) -> dict[str, str]:
    """Blocks (names or files), each once, by the names that tables and files give them; `kind` says what they are.

    Raises:
        DrivelineError: two have the same name, or a controller that of the run without damping.
    """
    named: dict[str, str] = {}
    for block in blocks:
        if named.setdefault(Path(block).stem, block) != block:
            raise DrivelineError(f"two {kind}s are called {Path(block).stem}; rename the file of one")
    if kind == "controller" and "off" in named:
        raise DrivelineError(f"the run without damping is called off, not a controller; rename the file {named['off']}")
    return named
