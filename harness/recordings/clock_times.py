"""Times of day, with or without a date, and durations, as seconds."""

import re
from collections.abc import Sequence
from datetime import date
from typing import NamedTuple

import numpy as np

DAY, HOUR = 86400.0, 3600.0

EPOCH = date(1970, 1, 1).toordinal()
"""Number of the day from which computers count."""

EXAMPLES = "10:15:30.5 or 2026-11-22T10:15:30.5"

ENGLISH = ("jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec")
MONTHS = {name: k for k, name in enumerate(ENGLISH, 1)} | {"mär": 3, "mrz": 3, "mai": 5, "okt": 10, "dez": 12}
"""By three letters of their names, in English and German."""

INSTANT = re.compile(
    r"((?P<year>\d{4})(?P<mark>[-/.])(?P<month>\d\d?)(?P=mark)(?P<day>\d\d?)[T ]\s*"
    r"|(?P<first>\d\d?)(?P<between>[-/.])(?P<second_>\d\d?)(?P=between)(?P<year_>\d{4}|\d\d)[T ,]\s*"
    r"|(\w+,? )?(?P<day_>\d\d?)[-. ]+(?P<name>[a-zä]{3})[a-z]*[-,. ]+(?P<year__>\d{4})[T ,]\s*"
    r"|(\w+,? )?(?P<name_>[a-zä]{3})[a-z]*[. ]+(?P<day__>\d\d?),? (?P<year___>\d{4})[T ,]\s*)?"
    r"(?P<hour>\d\d?)(?P<colon>:?)(?P<minute>[0-5]\d)(?P=colon)(?P<second>[0-5]\d([.,:]\d+)?)"
    r"\s?(?P<half>[AP]\.?M\.?)?(?P<zone>Z| ?UTC| ?GMT|(?P<ahead>[+-])(?P<hours>\d\d):?(?P<minutes>\d\d))?",
    re.ASCII | re.IGNORECASE,
)
"""ISO 8601 with the time of day, other dates in numbers and with the name of the month, or the time of day alone."""

MINUTES = re.compile(r"(?P<minute>\d+):(?P<second>[0-5]\d[.,]\d+)", re.ASCII)
"""Minutes and seconds with a fraction, without which it could be hours and minutes."""

DURATION = re.compile(
    r"[+-]?\d[\d.,]*\s*(days?\b.*|(h|hr|hrs|hours?|min|minutes?|s|sec|secs|seconds?|ms|us|ns)\b\.?)", re.IGNORECASE
)
"""What pandas reads: `0.1 sec`, `0 days 00:00:00.1`."""


class Clock(NamedTuple):
    """What a clock says: number of the day, None without a date, and seconds within it, in UTC if it has a zone."""

    day: int | None
    second: float

    def __str__(self) -> str:
        second = round(self.second, 6)
        day = f"{date.fromordinal(self.day)} " if self.day else ""
        return f"{day}{int(second // HOUR):02}:{int(second % HOUR // 60):02}:{second % 60:09.6f}".rstrip("0").rstrip(
            "."
        )

    def after(self, begin: "Clock", last: float) -> float:
        """Seconds from another clock on; without a date within a day of it, before it only if `last` seconds after it
        this clock has not come yet."""
        if self.day is not None and begin.day is not None:
            return DAY * (self.day - begin.day) + self.second - begin.second
        later = (self.second - begin.second) % DAY
        return later - DAY if later > last and later > DAY / 2 else later


def is_clock_time(text: str) -> bool:
    """Whether it is a time of day or a duration."""
    return bool(read_clock(text) or MINUTES.fullmatch(text.strip()) or DURATION.fullmatch(text.strip()))


def read_clock(text: str, month_first: bool = True) -> Clock | None:
    """What a clock says, None if it is something else.

    Args:
        month_first: in a date in numbers with slashes.
    """
    found = INSTANT.fullmatch(text.strip())
    if not found:
        return None
    hour = int(found["hour"])
    if found["half"]:
        hour = hour % 12 + 12 * (found["half"][0].upper() == "P")
    ahead = 0.0
    if found["ahead"]:
        ahead = (-1.0 if found["ahead"] == "-" else 1.0) * (HOUR * int(found["hours"]) + 60.0 * int(found["minutes"]))
    second = float(found["second"].replace(",", ".").replace(":", "."))
    within = HOUR * hour + 60.0 * int(found["minute"]) + second - ahead
    year = found["year"] or found["year_"] or found["year__"] or found["year___"]
    if not year:
        return Clock(None, within)
    if named := found["name"] or found["name_"]:
        month, day = MONTHS.get(named.lower(), 0), found["day_"] or found["day__"]
    elif found["month"]:
        month, day = found["month"], found["day"]
    else:
        month, day = found["first"], found["second_"]
        if found["between"] == "." or not month_first:
            month, day = day, month
    try:
        return Clock(date(int(year) + 2000 * (len(year) == 2), int(month), int(day)).toordinal(), within)
    except ValueError:
        return None  # the 30th of February


def seconds(texts: Sequence[str]) -> tuple[np.ndarray, Clock | None]:
    """Times in s, NaN where a text is none of the form of the first one, and what the clock says at 0.

    Times of day count from the first one on; without a date they go on at midnight. Durations are as they are, those in
    minutes go on after the hour. Of 11/12/2026 the month is what makes the recording the shorter one.
    """
    first = next((text for text in texts if is_clock_time(text)), "")
    if read_clock(first):
        readings = [_since([read_clock(text, month_first) for text in texts]) for month_first in _orders(first)]
        return min(readings, key=lambda reading: (np.isnan(reading[0]).sum(), _length(reading[0])))
    if MINUTES.fullmatch(first.strip()):
        found = [MINUTES.fullmatch(text.strip()) for text in texts]
        values = [60.0 * int(f["minute"]) + float(f["second"].replace(",", ".")) if f else np.nan for f in found]
        return _unwrapped(np.array(values), HOUR), None
    import pandas as pd  # takes most of a second

    spans = pd.to_timedelta([text.strip().replace(",", ".") for text in texts], errors="coerce")
    return spans.total_seconds().to_numpy(dtype=float), None


def _orders(first: str) -> tuple[bool, ...]:
    return (True, False) if re.match(r"\s*\d\d?[-/]\d\d?[-/]", first) else (True,)


def _length(times: np.ndarray) -> float:
    return float(np.nanmax(times, initial=0.0) - np.nanmin(times, initial=0.0))


def _since(clocks: Sequence[Clock | None]) -> tuple[np.ndarray, Clock | None]:
    """Seconds from the first clock on; those that have a date where it has none, or none where it has one, are NaN."""
    begin = next((clock for clock in clocks if clock), None)
    if begin is None:
        return np.full(len(clocks), np.nan), None
    alike = [clock if clock and (clock.day is None) == (begin.day is None) else None for clock in clocks]
    within = np.array([clock.second - begin.second if clock else np.nan for clock in alike])
    if begin.day is None:
        return _unwrapped(within, DAY), begin
    days = np.array([clock.day - begin.day if clock and clock.day else 0 for clock in alike], dtype=float)
    return DAY * days + within, begin


def _unwrapped(times: np.ndarray, period: float) -> np.ndarray:
    """Times that begin again after a period."""
    there = np.isfinite(times)
    turns = np.append(0.0, np.cumsum(np.diff(times[there]) < -0.5 * period))[: there.sum()]
    times = times.copy()
    times[there] += period * turns
    return times
