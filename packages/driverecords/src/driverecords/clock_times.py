"""Times of day, with or without a date, and durations, as seconds."""

import re
from collections.abc import Sequence
from datetime import date
from math import isnan, nan
from typing import NamedTuple
from unicodedata import combining, normalize

import numpy as np

DAY, HOUR = 86400.0, 3600.0

EPOCH = date(1970, 1, 1).toordinal()
"""Number of the day from which computers count."""

EXAMPLES = "10:15:30.5 or 2026-11-22T10:15:30.5"

NAMES = """
    jan|ene|gen feb|fev mar|mrz apr|avr|abr may|mai|mag jun|juin|giu jul|juil|lug aug|aou|ago sep|set oct|okt|ott nov
    dec|dez|dic
"""
MONTHS = {name: k for k, names in enumerate(NAMES.split(), 1) for name in names.split("|")}
"""By the first letters of their names without accents, in English, German, French, Spanish and Italian."""

NAMED = rf"(?P<name>{'|'.join(sorted(MONTHS, key=len, reverse=True))})[a-z]*"
WEEKDAY = r"(?:[a-z]+[.,]{0,2} +)?"

TIME = re.compile(
    # VBOX writes 101557.00 without colons, others 10:15:30:500 or 10h15m30s
    r"(?P<date>.*?)(?:[T ,:] *)?(?P<hour>\d\d?)(?P<colon>[:h]?)(?P<minute>[0-5]\d)(?:(?P=colon)|m)"
    r"(?P<second>[0-5]\d(?:[.,:]\d+)?)s? ?(?P<half>[AP]\.?M\.?|vorm\.?|nachm\.?)?"
    r"(?P<zone>Z| ?UTC| ?GMT| ?(?P<ahead>[+-])(?P<hours>\d\d):?(?P<minutes>\d\d)?)?"
    r"(?: Uhr| [A-Z]{3,5}|\[[\w/]+\])?(?P<year> \d{4})?",
    re.ASCII | re.IGNORECASE,
)
"""A time of day, what is before it, the year that C writes behind it; the name of a zone is passed over."""

DATES = tuple(
    re.compile(form, re.IGNORECASE)
    for form in (
        # 20260105 has all of its digits: 2026111 is the 11th of January or the 1st of November
        r"(?!\d{1,7}$)(?P<year>\d{4})(?P<mark>[-/.年]?)(?P<month>\d\d?)(?:(?P=mark)|月)(?P<day>\d\d?)日?",
        r"(?P<first>\d\d?)(?P<mark>[-/.])(?P<second>\d\d?)(?P=mark)(?P<year>\d{4}|\d\d)",
        rf"{WEEKDAY}(?P<day>\d\d?)[-. ]+{NAMED}[-,. ]+(?P<year>\d{{4}}|\d\d)",
        rf"{WEEKDAY}{NAMED}[. ]+(?P<day>\d\d?),? (?P<year>\d{{4}})",
    )
)
"""ISO 8601, other dates in numbers, and with the name of the month."""

MINUTES = re.compile(r"(?P<minute>\d+):(?P<second>[0-5]\d[.,]\d+)", re.ASCII)
"""Minutes and seconds with a fraction, without which it could be hours and minutes."""

LENGTHS = {
    **dict.fromkeys(("d", "day", "days"), DAY),
    **dict.fromkeys(("h", "hr", "hrs", "hour", "hours"), HOUR),
    **dict.fromkeys(("m", "min", "mins", "minute", "minutes"), 60.0),
    **dict.fromkeys(("s", "sec", "secs", "second", "seconds"), 1.0),
    "ms": 1e-3,
    "us": 1e-6,
    "µs": 1e-6,
    "ns": 1e-9,
}
"""Of the parts of a duration, in s."""

PART = re.compile(rf"(\d+(?:\.\d*)?(?:e[+-]?\d+)?)\s*({'|'.join(sorted(LENGTHS, key=len, reverse=True))})(?![a-su-zµ])")
DURATION = re.compile(
    # pandas writes `0 days 00:00:00.1`, Python `1 day, 0:00:00.1`, ISO 8601 `P0DT0H0M0.1S`
    rf"(?P<sign>[+-]?)p?(?P<parts>(?:t?{PART.pattern}[\s.]*)*)[t+]?(?P<clock>\d+:[0-5]\d:[0-5]\d(?:\.\d*)?)?"
)
"""`0.1 sec`, `1 min 2.5 s`, `0 days 00:00:00.1`, and PT0.1S of ISO 8601, in small letters."""


class Clock(NamedTuple):
    """What a clock says.

    Attributes:
        day: its number, None without a date.
        second: within it, as it is written.
        ahead: of UTC, in s; None if no zone is written.
    """

    day: int | None
    second: float
    ahead: float | None = None

    def __str__(self) -> str:
        second = round(self.second, 6)
        day = f"{date.fromordinal(self.day)} " if self.day else ""
        return f"{day}{int(second // HOUR):02}:{int(second % HOUR // 60):02}:{second % 60:09.6f}".rstrip("0").rstrip(
            "."
        )

    def after(self, begin: "Clock", last: float) -> float:
        """Seconds from another clock on, by UTC if both have a zone; without a date within a day of it, before it only
        if `last` seconds after it this clock has not come yet."""
        within = self.second - begin.second
        if self.ahead is not None and begin.ahead is not None:
            # a clock that is set back in October goes on by its zone
            within -= self.ahead - begin.ahead
        if self.day is not None and begin.day is not None:
            return DAY * (self.day - begin.day) + within
        later = within % DAY
        return later - DAY if later > last and later > DAY / 2 else later


def is_clock_time(text: str) -> bool:
    """Whether it is a time of day or a duration."""
    return bool(read_clock(text) or MINUTES.fullmatch(text.strip()) or not isnan(_duration(text)))


def read_clock(text: str, month_first: bool = True) -> Clock | None:
    """What a clock says, None if it is something else.

    Args:
        month_first: in a date in numbers with slashes.
    """
    if not text.isascii():
        # août, févr., and the narrow blank that newer systems put before AM
        text = "".join(letter for letter in normalize("NFKD", text) if not combining(letter))
    match = TIME.fullmatch(" ".join(text.split()))
    if not match:
        return None
    hour = int(match["hour"])
    if match["half"]:
        hour = hour % 12 + 12 * (match["half"][0].upper() in "PN")
    ahead = 0.0 if match["zone"] else None
    if match["ahead"]:
        ahead = float(match["ahead"] + "1") * (HOUR * int(match["hours"]) + 60.0 * int(match["minutes"] or 0))
    second = float(match["second"].replace(",", ".").replace(":", "."))
    within = HOUR * hour + 60.0 * int(match["minute"]) + second
    written = match["date"] + (match["year"] or "")
    if not written:
        return Clock(None, within, ahead)
    dated = next((date_match.groupdict() for form in DATES if (date_match := form.fullmatch(written))), None)
    if dated is None:
        return None
    if "first" in dated:
        month, day = (dated[part] for part in ("first", "second"))
        if dated["mark"] == "." or not month_first:
            month, day = day, month
    else:
        month, day = dated.get("month") or MONTHS[dated["name"].lower()], dated["day"]
    year = int(dated["year"]) + 2000 * (len(dated["year"]) == 2)
    try:
        return Clock(date(year, int(month), int(day)).toordinal(), within, ahead)
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
        matches = [MINUTES.fullmatch(text.strip()) for text in texts]
        values = [60.0 * int(f["minute"]) + float(f["second"].replace(",", ".")) if f else np.nan for f in matches]
        return _unwrapped(np.array(values), HOUR), None
    return np.array([_duration(text) for text in texts]), None


def _duration(text: str) -> float:
    """In s, NaN of what is none."""
    match = DURATION.fullmatch(text.strip().casefold().replace(",", ".").replace("\u03bc", "µ"))
    parts = PART.findall(match["parts"]) if match else []
    if not match or not (parts or match["clock"]) or [unit for _, unit in parts] == ["m"]:  # which are metres
        return nan
    length = sum(float(number) * LENGTHS[unit] for number, unit in parts) * (-1.0 if match["sign"] == "-" else 1.0)
    if match["clock"]:
        hour, minute, second = map(float, match["clock"].split(":"))
        within = HOUR * hour + 60.0 * minute + second
        length += -within if match["sign"] == "-" and not parts else within
    return length


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
    if begin.day is None:
        return _unwrapped(np.array([clock.after(begin, -DAY) if clock else np.nan for clock in alike]), DAY), begin
    return np.array([clock.after(begin, 0.0) if clock else np.nan for clock in alike]), begin


def _unwrapped(times: np.ndarray, period: float) -> np.ndarray:
    """Times that begin again after a period."""
    there = np.isfinite(times)
    # a step back by less is a row out of its place, which is refused by name
    turns = np.append(0.0, np.cumsum(np.diff(times[there]) < -0.5 * period))[: there.sum()]
    times = times.copy()
    times[there] += period * turns
    return times
