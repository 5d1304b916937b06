"""Units in Modelica notation and what they are in SI base units, as FMI wants them defined."""

import re
from collections import Counter

BASE_UNITS = ("kg", "m", "s", "A", "K", "mol", "cd", "rad")
"""In the order of the FMI schema."""

DERIVED_UNITS = {
    "N": {"kg": 1, "m": 1, "s": -2},
    "J": {"kg": 1, "m": 2, "s": -2},
    "W": {"kg": 1, "m": 2, "s": -3},
    "Pa": {"kg": 1, "m": -1, "s": -2},
    "Hz": {"s": -1},
    "V": {"kg": 1, "m": 2, "s": -3, "A": -1},
}


NOMINAL = {"N.m": 100.0, "rad/s": 100.0, "rad": 0.1, "m/s": 10.0, "m/s2": 1.0}
"""How large quantities of a drive train are, motor side; for those that are not declared with a value of their own."""


def rate_unit(unit: str) -> str:
    """The unit of the rate at which a quantity of that unit changes: "rad/s" gives rad/s2."""
    numerator, _, denominator = unit.partition("/")
    factors = [factor for factor in denominator.strip("()").split(".") if factor]
    times = [factor for factor in factors if re.fullmatch(r"s\d*", factor)]
    exponent = sum(int(factor[1:] or 1) for factor in times) + 1
    factors = [factor for factor in factors if factor not in times] + [f"s{exponent if exponent > 1 else ''}"]
    return f"{numerator}/{factors[0]}" if len(factors) == 1 else f"{numerator}/({'.'.join(factors)})"


def base_exponents(unit: str) -> dict[str, int]:
    """Exponents of the SI base units, in the order of the schema: "N.m/rad" gives kg 1, m 2, s -2, rad -1.

    A dot multiplies, one slash divides by all that follows it (in brackets if it is a product), a
    number behind a symbol is its exponent: "N.s2/m2", "J/(kg.K)", "1/s".

    Raises:
        ValueError: a symbol that is not known, or a notation other than this.
    """
    numerator, _, denominator = unit.partition("/")
    exponents: Counter[str] = Counter()
    for part, sense in ((numerator, 1), (denominator.removeprefix("(").removesuffix(")"), -1)):
        for factor in part.split(".") if part not in ("", "1") else ():
            match = re.fullmatch(r"([A-Za-z]+)(-?\d+)?", factor)
            if match is None:
                raise ValueError(f"unit {unit!r}: {factor!r} is not a symbol with an exponent")
            symbol, exponent = match[1], sense * int(match[2] or 1)
            if symbol not in DERIVED_UNITS and symbol not in BASE_UNITS:
                known = ", ".join((*BASE_UNITS, *DERIVED_UNITS))
                raise ValueError(f"unit {unit!r}: {symbol!r} is not among the known ones: {known}")
            for base, power in DERIVED_UNITS.get(symbol, {symbol: 1}).items():
                exponents[base] += exponent * power
    return {base: exponents[base] for base in BASE_UNITS if exponents[base]}
