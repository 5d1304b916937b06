"""Times of day, with or without a date, as seconds from the first one on."""

import re
from collections.abc import Sequence
from datetime import date

import numpy as np

DAY = 86400.0

EXAMPLES = "10:15:30.5 or 2026-11-22T10:15:30.5"

INSTANT = re.compile(
    r"((?P<year>\d{4})(?P<mark>[-/.])(?P<month>\d\d?)(?P=mark)(?P<day>\d\d?)[T ]\s*"
    r"|(?P<german_day>\d\d?)\.(?P<german_month>\d\d?)\.(?P<german_year>\d{4})[T ]\s*)?"
    r"(?P<hour>\d\d?):(?P<minute>[0-5]\d):(?P<second>[0-5]\d([.,]\d+)?)"
    r"\s?(?P<half>[AP]M)?(?P<zone>Z|(?P<ahead>[+-])(?P<hours>\d\d):?(?P<minutes>\d\d))?",
    re.ASCII | re.IGNORECASE,
)
"""ISO 8601 with the time of day, a date in German, or the time of day alone. Whether 11/12/2026 is in November or in
December cannot be known."""


def is_clock_time(text: str) -> bool:
    """Whether it is one."""
    return _parsed(text) is not None


def seconds(texts: Sequence[str]) -> np.ndarray | int:
    """Seconds from the first one on; the index of the first one that is none. After midnight a time without a date is
    on the next day."""
    parsed = []
    for k, text in enumerate(texts):
        one = _parsed(text)
        if one is None or (one[0] is None) != ((parsed or [one])[0][0] is None):
            return k
        parsed.append(one)
    within = np.array([second for _, second in parsed])
    if parsed and parsed[0][0] is None:
        days = np.append(0.0, np.cumsum(np.diff(within) < -0.5 * DAY))
    else:
        days = np.array([day for day, _ in parsed], dtype=float)
    return DAY * (days - days[:1]) + (within - within[:1])


def _parsed(text: str) -> tuple[int | None, float] | None:
    """Number of the day, None without a date, and seconds within it, in UTC where there is a zone."""
    found = INSTANT.fullmatch(text.strip())
    if not found:
        return None
    hour = int(found["hour"])
    if found["half"]:
        hour = hour % 12 + 12 * (found["half"].upper() == "PM")
    ahead = 0.0
    if found["ahead"]:
        ahead = (-1.0 if found["ahead"] == "-" else 1.0) * (3600.0 * int(found["hours"]) + 60.0 * int(found["minutes"]))
    within = 3600.0 * hour + 60.0 * int(found["minute"]) + float(found["second"].replace(",", ".")) - ahead
    dated = [found[name] or found[f"german_{name}"] for name in ("year", "month", "day")]
    try:
        return (date(*map(int, dated)).toordinal() if all(dated) else None), within
    except ValueError:
        return None  # the 30th of February
