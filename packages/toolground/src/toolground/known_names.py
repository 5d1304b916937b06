"""Names: their words, and what to say of one that is not known."""

import re
from collections.abc import Iterable
from difflib import get_close_matches
from typing import TypeVar

from .errors import UserError

Named = TypeVar("Named")

WORD = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])|\d")


def words_of(name: str) -> list[str]:
    """The words of a name in small letters, of camel case too; a digit is a word."""
    return [word.lower() for word in WORD.findall(name)]


RENAMED: dict[str, str] = {}
"""Names that a program once had, by what they are called now; the program adds them."""


def meant(name: str, known: Iterable[str]) -> str:
    """What to say of an unknown name, for example "did you mean tipin15 or tipin50?": the known ones nearest to it; of
    a variable without its instance those of all instances. Empty: none is near."""
    names = list(known)
    if RENAMED.get(name) in names:
        return f"it is called {RENAMED[name]} now"
    by_folded = {candidate.casefold(): candidate for candidate in names}
    near = [by_folded[match] for match in get_close_matches(name.casefold(), by_folded, n=3)]
    close = [candidate for candidate in names if candidate.rpartition(".")[2] == name] or near
    return f"did you mean {' or '.join(close)}?" if close else ""


def nearest(name: str, known: Iterable[str], every: str = "known are") -> str:
    """What to say of an unknown name: the known ones nearest to it, or all of them if none is near.

    For example "did you mean tipin15 or tipin50?" or "known are: drive, creep".

    Args:
        every: words before all of them.
    """
    names = list(known)
    return meant(name, names) or f"{every}: {', '.join(names)}"


class UnknownName(UserError, KeyError):
    """Nothing has this name; the message names what is near."""

    __str__ = UserError.__str__


class ByName(dict[str, Named]):
    """What has names; of one that is not known it says what is near.

    Raises:
        UnknownName: nothing has the name.
    """

    def __missing__(self, name: str) -> Named:
        raise UnknownName(f"{name} is not known; {nearest(str(name), self)}")
