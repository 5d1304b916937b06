"""Headings of columns: name and unit, as in `Motor Speed [rpm]`, `Motor Speed (rpm)`, `Motor Speed / rpm`, `Motor Speed
- rpm`, `Motor Speed in rpm`, `motor_speed_rpm` and `Motor.Speed..rpm.`."""

import re
from collections.abc import Iterator
from unicodedata import normalize

IN_BRACKETS = re.compile(
    r"(?P<name>.*?)\s*(?:\[(?P<square>[^\[\]]*)\]?|\((?P<round>.*)\)|\{(?P<curly>.*)\}|<(?P<angle>.*)>)\s*", re.DOTALL
)

TAG = re.compile(
    r"\s*[(\[](?:0x[0-9a-f]+|(?:CAN|LIN|XCP|CCP|ETK\w?|FlexRay)\W*\d*|[01](?=[)\]]\s*[(\[]))[)\]]"
    r"|(?<=[)\]])\s*[(\[]\d+ ?(?:ms|s|Hz)[)\]]",
    re.IGNORECASE,
)
"""Bus, frame, first element or rate in brackets beside the unit: `v (CAN 1) [km/h]`, `v [km/h] (10 ms)`."""


def split(heading: str) -> tuple[str, str | None]:
    """Name, and unit if one stands behind it in brackets of any kind."""
    heading = TAG.sub("", heading).strip(" :")
    match = IN_BRACKETS.fullmatch(heading)
    if not match:
        return heading, None
    unit = next(group for group in match.groups()[1:] if group is not None)
    return OPENING.sub("", match["name"]).strip(), re.sub("^unit: *", "", unit.strip()) or None


OPENING = re.compile(r"\s*/\s*$|\s+in\s*$")
"""What may stand between a name and a unit in brackets: `v/(km/h)`, `T in [Nm]`."""

BEHIND = (
    re.compile(r"(?P<name>[^/]+?)\s*/\s*(?P<unit>.+)"),
    re.compile(r"(?P<name>.+)\s+in\s+(?P<unit>\S.*)"),
    re.compile(r"(?P<name>.+?)(?:(?:\s+-|:|,)\s+|[|@]|::)(?P<unit>\S.*)"),
)
"""A quantity over its unit (ISO 80000-1), in words, and behind a mark."""


def without_brackets(name: str) -> Iterator[tuple[str, str]]:
    """Name and unit as they may stand in a heading without brackets: `T / Nm`, `v/(km/h)`, `T in Nm`, `v_kmh`, and
    `v_km_h` or, as R writes it, `v..km.h.` for km/h. Whether the unit is one is not asked."""
    for form in BEHIND:
        if match := form.fullmatch(name):
            yield match["name"].strip(), match["unit"].strip(" ()")
    # MATLAB makes Velocity__km_h_ of `Velocity [km/h]`, R Velocity..km.h.
    words = [word for word in re.split(r"[._]+", name) if word]
    for count in range(1, min(len(words), 3)):
        yield "_".join(words[:-count]), "/".join(words[-count:])


DEVICE = re.compile(r"(.*::)?([^\\]+?)(\s*\\.*)?", re.DOTALL)
"""What stands before and behind a name: the message in `ABS_1::Speed`, the device in `Speed\\XCP:1`."""


def key(name: str) -> str:
    """The same for names that differ in case, blanks, marks between words and their device alone (`MotorTorque`,
    `Motor-Torque`), or in how an umlaut is written. A minus before a name stays: the sign is the other."""
    match = DEVICE.fullmatch(name)
    return normalize("NFC", re.sub(r"[\s_./\u200b\ufeff]|(?!^)-", "", (match[2] if match else name).strip()).casefold())


def last_part(name: str) -> str:
    """A name without its path: `CAN1.ABS.Velocity`, `Model Root/Plant/Velocity`."""
    return re.split(r"[./]", name)[-1]
