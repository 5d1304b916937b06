"""Numbers as people write them: digits, a point, an exponent; what else Python takes for a number is a slip."""

import re

REAL = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)(e[+-]?\d+)?|[+-]?inf|nan", re.ASCII | re.IGNORECASE)


def real(text: str) -> float | None:
    """The number that a text is, perhaps NaN or infinite; None if it is none."""
    return float(text) if REAL.fullmatch(text) else None


def whole(text: str, most_digits: int) -> int | None:
    """The whole number of so many digits that a text is, without a sign; None if it is none."""
    return int(text) if text.isascii() and text.isdecimal() and len(text) <= most_digits else None
