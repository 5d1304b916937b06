"""Headings of columns: name and unit, as in `Motor Speed [rpm]`, `Motor Speed (rpm)`, `Motor Speed / rpm`, `Motor Speed
- rpm`, `Motor Speed in rpm` and `motor_speed_rpm`."""

import re
from collections.abc import Iterator
from unicodedata import normalize

IN_BRACKETS = re.compile(
    r"(?P<name>.*?)\s*(?:\[(?P<square>[^\[\]]*)\]?|\((?P<round>.*)\)|\{(?P<curly>.*)\}|<(?P<angle>.*)>)\s*", re.DOTALL
)


def split(heading: str) -> tuple[str, str | None]:
    """Name, and unit if one stands behind it in brackets of any kind."""
    found = IN_BRACKETS.fullmatch(heading)
    if not found:
        return heading.strip(), None
    unit = next(each for each in found.groups()[1:] if each is not None)
    return OPENING.sub("", found["name"]).strip(), unit.strip() or None


OPENING = re.compile(r"\s*/\s*$|\s+in\s*$")
"""What may stand between a name and a unit in brackets: `v/(km/h)`, `T in [Nm]`."""

BEHIND = (
    re.compile(r"(?P<name>[^/]+?)\s*/\s*(?P<unit>.+)"),
    re.compile(r"(?P<name>.+)\s+in\s+(?P<unit>\S.*)"),
    re.compile(r"(?P<name>.+?)(?:\s+-|:|,)\s+(?P<unit>\S.*)"),
)
"""A quantity over its unit (ISO 80000-1), in words, and behind a mark."""


def without_brackets(name: str) -> Iterator[tuple[str, str]]:
    """Name and unit as they may stand in a heading without brackets: `T / Nm`, `v/(km/h)`, `T in Nm`, `v_kmh`, and
    `v_km_h` for km/h. Whether the unit is one is not asked."""
    for form in BEHIND:
        if found := form.fullmatch(name):
            yield found["name"].strip(), found["unit"].strip(" ()")
    for words in (1, 2):
        first, *last = name.rsplit("_", words)
        if len(last) == words and first and all(last):
            yield first, "/".join(last)


DEVICE = re.compile(r"(.*::)?([^\\]+?)(\s*\\.*)?", re.DOTALL)
"""What stands before and behind a name: the message in `ABS_1::Speed`, the device in `Speed\\XCP:1`."""


def key(name: str) -> str:
    """The same for names that differ in case, spaces, underscores and their device alone (`MotorTorque`), or in how an
    umlaut is written."""
    found = DEVICE.fullmatch(name)
    bare = found[2] if found else name
    return normalize("NFC", "".join(bare.replace("_", " ").split()).casefold())
