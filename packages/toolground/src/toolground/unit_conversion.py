"""How units that are written as in Modelica and FMI convert into each other."""

import re
from functools import cache
from math import isfinite
from typing import Any, cast

from .written_numbers import real

LONGEST = 60
"""Characters of a unit. Real ones have up to 20; thousands of factors would be more than pint can nest."""

SYMBOL = r"(?:[A-Za-zµΩ%°]+(?:\^?[+-]?[1-9])?|1)"
"""Its exponent has one digit, as all real ones: the power of a number to one of eight digits takes for ever."""
PRODUCT = rf"{SYMBOL}(?:[.*]{SYMBOL})*"
UNIT = re.compile(rf"{PRODUCT}(?:/(?:{SYMBOL}|\({PRODUCT}\)))?")
"""A product, over one symbol or a product in brackets: N.m, kg.m2, s-1, N.m/rad, J/(kg.K), 1."""

SIGNS = str.maketrans(
    {"·": ".", "⋅": ".", "∙": ".", "*": ".", "²": "2", "³": "3", "\u03bc": "µ", "−": "-", "\N{NO-BREAK SPACE}": " "}
)

SPELLED = {
    **dict.fromkeys(("kmh", "kph", "kmph", "km/hr"), "km/h"),
    # speeds in revolutions; as plain frequencies they would be off by 2 pi
    **dict.fromkeys(
        ("rpm", "RPM", "U/min", "1/min", "/min", "min-1", "min^-1", "rev/min", "revs/min", "r/min"), "turn/min"
    ),
    "rev": "turn",
    **dict.fromkeys(("sec", "secs", "seconds", "Sec"), "s"),
    **dict.fromkeys(("-", "--", ":1", "bool", "Boolean"), "1"),
    "mps": "m/s",
    "grad": "deg",  # the German word, which pint takes for 1/400 of a turn
    "Grad": "deg",
}
"""Units as tools and loggers write them, which pint takes for something else or not at all."""

POUNDS = re.compile(r"(?P<force>lbs?f?)[ .-]?(?P<arm>ft|in)|(?P<first>ft|in)[ .-]?lbs?f?", re.IGNORECASE)
"""Torque in pounds: lb-ft, ft-lb, lbf.in."""

TORQUE = re.compile(r"(?P<prefix>[mkM]?)N[ .-]?m(?P<damping>[ .]?s)?(?P<per>/.+)?")
INERTIA = re.compile(r"kg[ .]?m\^?2")
"""N.m, N.m/rad, N.m.s/rad, and kg.m2, with or without dots."""

WITH_UNIT = re.compile(r"([+-]?[\d.]+(?:[eE][+-]?\d+)?)(?: +|(?![\d\s.,_]))(\S.*)")
"""A number and a unit, which begins with a digit (1/min) after a blank alone."""

NESTED = re.compile(r"/\(([^()/]+)/([^()/]+)\)")
"""A quotient below the line: N.m/(rad/s)."""

WRITTEN = "km/h kmh kph m/s rpm U/min 1/min rad/s deg/s Nm kNm s ms min h m km ft"

FOLDED = {unit.casefold(): unit for unit in WRITTEN.split()}
"""Units whose case is known where a unit as it is written does not convert: KM/H, NM, nm."""

STANDARD_GRAVITY = 9.80665
"""What an acceleration in g is multiplied by to be in m/s2."""

SI = "SI"
"""Stands for the unit of the SI, whatever the dimension."""


def spelled(unit: str) -> str:
    """The unit as in Modelica."""
    text = unit.replace("**", "^").translate(SIGNS).strip()
    text = SPELLED.get(text, text)
    text = NESTED.sub(r".\2/\1", text)
    if torque := TORQUE.fullmatch(text):
        return f"{torque['prefix']}N.m{'.s' if torque['damping'] else ''}{torque['per'] or ''}"
    if INERTIA.fullmatch(text):
        return "kg.m2"
    if pounds := POUNDS.fullmatch(text):
        return f"lbf.{(pounds['arm'] or pounds['first']).lower()}"
    return text.replace("°", "deg").replace(" ", ".")


@cache
def factor(unit: str, target_unit: str) -> float:
    """What a value in a unit is multiplied by to be in the wanted one.

    An angle is a dimension here: Hz and rad/s, or N.m and N.m/rad, do not convert into each other. In an acceleration,
    g is that of the Earth and not the gram.

    Raises:
        ValueError: a unit is not known, or they do not convert by a factor; the message is to stand after
            the name of the variable.
    """
    if unit == target_unit:
        return 1.0
    if unit.strip() == "g" and target_unit == "m/s2":
        return STANDARD_GRAVITY
    try:
        return _finite(unit, target_unit)
    except ValueError:
        if (folded := FOLDED.get(unit.strip().casefold(), unit)) == unit:
            raise
        return _finite(folded, target_unit)


def quantity(text: str, target_unit: str) -> float:
    """The value in a unit of a text with a number and a unit, such as "15 km/h" or "1887kg".

    Raises:
        ValueError: it is no such text, or does not convert; the message is to stand after the text.
    """
    parts = WITH_UNIT.fullmatch(text.strip())
    value = real(parts[1]) if parts else None
    if parts is None or value is None or not isfinite(value):
        raise ValueError("must be a number and a unit")
    return value * factor(parts[2], target_unit)


def converts(unit: str, target_unit: str) -> bool:
    """Whether there is a factor."""
    try:
        factor(unit, target_unit)
    except ValueError:
        return False
    return True


def _finite(unit: str, target_unit: str) -> float:
    try:
        factor = _factor(unit, target_unit)
    except OverflowError:
        factor = 0.0
    if not (isfinite(factor) and factor):
        raise ValueError(f"is in {unit}, whose factor to {target_unit} is larger or smaller than a number can be")
    return factor


def _factor(unit: str, target_unit: str) -> float:
    registry = _registry()
    source = _parsed(unit, registry)
    base = registry.get_base_units(source)[1] if target_unit == SI else _parsed(target_unit, registry)
    if not source.is_compatible_with(base):
        raise ValueError(f"is in {unit}, which does not convert into {target_unit}")
    zero, unit_factor = (registry.convert(value, source, base) for value in (0.0, 1.0))
    if zero:
        raise ValueError(f"is in {unit}, which has an offset to {target_unit}; only factors are converted")
    return float(unit_factor)


def known(unit: str) -> bool:
    """Whether the text is a unit."""
    if unit.strip().casefold() in FOLDED:
        return True
    try:
        _parsed(unit, _registry())
    except ValueError:
        return False
    return True


@cache
def _registry() -> Any:
    import pint  # takes half a second, which only those who convert should pay

    registry = cast(Any, pint.UnitRegistry(on_redefinition="ignore"))
    registry.define("radian = [angle] = rad")
    return registry


def _parsed(unit: str, registry: Any) -> Any:
    import pint

    text = spelled(unit)
    try:
        if len(text) > LONGEST or not UNIT.fullmatch(text):
            raise ValueError(unit)
        powers = re.sub(r"([^\W\d_]|[%°])\^?([+-]?\d+)", r"\1**(\2)", text)
        return registry.Unit(powers.replace(".", "*"))
    except (ValueError, pint.PintError) as error:
        shown = repr(unit if len(unit) <= LONGEST else f"{unit[:LONGEST]} ... ({len(unit)} characters)")
        raise ValueError(f"is in {shown}, which is not a known unit (known are those such as N.m/rad)") from error
