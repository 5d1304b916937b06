"""Sentences about names that are not known."""

from collections.abc import Iterable
from difflib import get_close_matches


def nearest(name: str, known: Iterable[str]) -> str:
    """What to say of an unknown name: the known ones nearest to it, or all of them if none is near.

    For example "did you mean tipin15 or tipin50?" or "known are: drive, creep".
    """
    names = list(known)
    by_folded = {candidate.casefold(): candidate for candidate in names}
    close = [by_folded[match] for match in get_close_matches(name.casefold(), by_folded, n=3)]
    if close:
        return f"did you mean {' or '.join(close)}?"
    return f"known are: {', '.join(names)}"
