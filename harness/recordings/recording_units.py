"""Units as files of recordings write them, and their factors to those of the SI."""

import re
from functools import cache

from ..cosimulation.unit_conversion import factor, known

SIGNS = str.maketrans(
    {"·": ".", "⋅": ".", "∙": ".", "*": ".", "²": "2", "³": "3", "\u03bc": "µ", "−": "-", "\N{NO-BREAK SPACE}": " "}
)

SPELLED = {
    **dict.fromkeys(("kmh", "kph", "kmph", "km/hr"), "km/h"),
    **dict.fromkeys(("U/min", "1/min", "/min", "min^-1", "rev/min", "revs/min", "RPM"), "rpm"),
    **dict.fromkeys(("sec", "secs", "seconds", "Sec"), "s"),
    **dict.fromkeys(("-", "--", "bool", "Boolean"), "1"),
    "mps": "m/s",
    "grad": "deg",  # the German word, which pint takes for 1/400 of a turn
    "Grad": "deg",
}
"""Spellings that pint does not know, or takes for something else."""

WRITTEN = "km/h kmh kph m/s rpm U/min 1/min rad/s deg/s Nm kNm s ms min h m km ft"

FOLDED = {unit.casefold(): unit for unit in WRITTEN.split()}
"""Units whose case is known where a unit as it is written is none of the quantity: KM/H, NM, nm."""

POUNDS = re.compile(r"(?P<force>lbs?f?)[ .-]?(?P<arm>ft|in)|(?P<first>ft|in)[ .-]?lbs?f?", re.IGNORECASE)
"""Torque in pounds: lb-ft, ft-lb, lbf.in."""

TORQUE = re.compile(r"(?P<prefix>[mkM]?)N[ .-]?m")

STANDARD_GRAVITY = 9.80665
"""What an acceleration in g is multiplied by to be in m/s2."""


def spelled(unit: str) -> str:
    """The unit as in Modelica."""
    text = unit.replace("**", "^").translate(SIGNS).strip()
    text = SPELLED.get(text, text)
    torque = TORQUE.fullmatch(text)
    if torque:
        return f"{torque['prefix']}N.m"
    pounds = POUNDS.fullmatch(text)
    if pounds:
        return f"lbf.{(pounds['arm'] or pounds['first']).lower()}"
    return text.replace("°", "deg").replace(" ", ".")


@cache
def factor_to(target_unit: str, unit: str) -> float:
    """What a value in the unit of a file is multiplied by to be in the wanted one. In an acceleration, g is that of
    the Earth and not the gram.

    Raises:
        ValueError: it is not known or does not convert; the message is to stand after the name of the column.
    """
    if unit.strip() == "g" and target_unit == "m/s2":
        return STANDARD_GRAVITY
    try:
        return factor(spelled(unit), target_unit)
    except ValueError as reason:
        if (folded := FOLDED.get(unit.strip().casefold(), unit)) != unit:
            return factor_to(target_unit, folded)
        raise ValueError(f"{reason}; wanted is {target_unit} or what converts into it") from reason


def is_unit(text: str) -> bool:
    """Whether it is a unit that can be read."""
    return known(spelled(text)) or text.strip().casefold() in FOLDED
