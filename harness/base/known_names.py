"""Names: what to say of one that is not known, and whether they tell plants apart."""

from collections.abc import Iterable
from difflib import get_close_matches
from pathlib import Path

from ...fmus.names import RENAMED
from .errors import DrivelineError


def nearest(name: str, known: Iterable[str], every: str = "known are") -> str:
    """What to say of an unknown name: the known ones nearest to it, or all of them if none is near.

    For example "did you mean tipin15 or tipin50?" or "known are: drive, creep".

    Args:
        every: words before all of them.
    """
    names = list(known)
    if RENAMED.get(name) in names:
        return f"it is called {RENAMED[name]} now"
    by_folded = {candidate.casefold(): candidate for candidate in names}
    close = [by_folded[match] for match in get_close_matches(name.casefold(), by_folded, n=3)]
    if close:
        return f"did you mean {' or '.join(close)}?"
    return f"{every}: {', '.join(names)}"


def require_different(plants: Iterable[str | Path]) -> None:
    """Refuses plants, by name or file, that tables and files could not tell apart.

    Raises:
        DrivelineError: two have the same name.
    """
    names = [Path(plant).stem for plant in plants]
    for name in names:
        if names.count(name) > 1:
            raise DrivelineError(f"two plants are called {name}; rename the file of one")
