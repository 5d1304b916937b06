"""Units as files of recordings write them, and their factors to those of the SI."""

from functools import cache

from ..cosimulation.unit_conversion import factor, known

WRITTEN = "km/h kmh kph m/s rpm U/min 1/min rad/s deg/s Nm kNm s ms min h m km ft"

FOLDED = {unit.casefold(): unit for unit in WRITTEN.split()}
"""Units whose case is known where a unit as it is written is none of the quantity: KM/H, NM, nm."""

STANDARD_GRAVITY = 9.80665
"""What an acceleration in g is multiplied by to be in m/s2."""


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
        return factor(unit.replace("**", "^"), target_unit)
    except ValueError as reason:
        if (folded := FOLDED.get(unit.strip().casefold(), unit)) != unit:
            return factor_to(target_unit, folded)
        raise ValueError(f"{reason}; wanted is {target_unit} or what converts into it") from reason


def is_unit(text: str) -> bool:
    """Whether it is a unit that can be read."""
    return known(text) or text.strip().casefold() in FOLDED
