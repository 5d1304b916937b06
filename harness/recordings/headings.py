"""Headings of columns: name and unit, as in `Motor Speed [rpm]`, `Motor Speed (rpm)` and `motor_speed_rpm`."""

import re
from collections.abc import Iterator

IN_BRACKETS = re.compile(r"(?P<name>.*?)\s*(?:\[(?P<square>[^\[\]]*)\]?|\((?P<round>.*)\))\s*", re.DOTALL)


def split(heading: str) -> tuple[str, str | None]:
    """Name, and unit if one stands behind it in brackets or parentheses."""
    found = IN_BRACKETS.fullmatch(heading)
    if not found:
        return heading.strip(), None
    unit = found["square"] if found["square"] is not None else found["round"]
    return found["name"].strip(), unit.strip() or None


def after_underscores(name: str) -> Iterator[tuple[str, str]]:
    """Name and unit, if the last word or the last two are one: `v_kmh`, and `v_km_h` for km/h."""
    for words in (1, 2):
        first, *last = name.rsplit("_", words)
        if len(last) == words and first and all(last):
            yield first, "/".join(last)


def key(name: str) -> str:
    """The same for names that differ in case, spaces and underscores alone."""
    return " ".join(name.replace("_", " ").split()).casefold()
