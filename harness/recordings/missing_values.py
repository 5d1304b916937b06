"""Numbers that loggers write where there is no value."""

NINES = {sign * (10.0**digits - unit) for digits in (3, 4, 5, 6) for unit in (1.0, 0.1, 0.01) for sign in (1.0, -1.0)}
"""999, 9999.9, ..."""

ENDS = {2.0**8 - 1.0, 2.0**16 - 1.0, 2.0**15 - 1.0, -(2.0**15), 2.0**32 - 1.0, 2.0**31 - 1.0, -(2.0**31)}
"""Of integers of 8, 16 and 32 bits."""


def is_code(value: float) -> bool:
    """Whether a number of a file is one of them."""
    return any(abs(value - code) < 1e-9 * abs(code) for code in NINES | ENDS)
