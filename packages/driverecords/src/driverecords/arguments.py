"""The arguments of a command that reads a recording: which columns it has, from when to when."""

from argparse import ArgumentTypeError
from math import isfinite
from pathlib import Path
from typing import Any

from toolground.arguments import option, positional, record
from toolground.errors import UserError
from toolground.known_names import nearest
from toolground.plain_text import quoted
from toolground.written_numbers import real

from .clock_times import Clock, read_clock
from .quantities import QUANTITIES, aliases, example
from .time_base import Cut

NAMES = aliases()


def examples(*quantities: str) -> list[str]:
    """Headings of quantities, for help."""
    return [example(quantity, NAMES) for quantity in quantities]


def column(text: str) -> tuple[str, str]:
    """Quantity and heading of `quantity=heading`."""
    quantity, equals, heading = (part.strip() for part in text.partition("="))
    if not (quantity and equals and heading):
        raise ArgumentTypeError(f"{quoted(text)} is not of the form v='Speed 2 [km/h]'")
    if quantity not in QUANTITIES:
        raise ArgumentTypeError(f"{quoted(quantity)} is no quantity; {nearest(quantity, QUANTITIES)}")
    return quantity, heading


def instant(text: str) -> float | Clock:
    """Seconds, or a time of day with or without a date."""
    number = real(text)
    if number is not None and isfinite(number):
        return number
    clock = read_clock(text) or read_clock(f"{text}:00")
    if clock is None:
        raise ArgumentTypeError(f"{quoted(text)} is neither seconds nor a time of day, as in 12.5 or 10:15:30.5")
    return clock


def recording(what: str, nargs: str | None = None) -> Any:
    """RECORDING, of what is recorded."""
    return positional(f"{what} (docs/recordings.md)", Path, "RECORDING", nargs)


@record
class Headings:
    """What of a recording is read, and what its columns are called."""

    from_: float | Clock | None = option(
        None, "read it from then on: seconds, or a time of day", instant, metavar="TIME"
    )
    to: float | Clock | None = option(None, "read it up to then", instant, metavar="TIME")

    dbc: tuple[Path, ...] = option(
        (), "of a log of a bus (BLF, ASC): what its frames mean (repeatable)", Path, metavar="FILE.dbc"
    )
    column: tuple[tuple[str, str], ...] = option(
        (), "as v='Speed 2 [km/h]', or T_mot=-Torque to turn a sign (repeatable)", column, metavar="QUANTITY=HEADING"
    )
    aliases: tuple[Path, ...] = option(
        (), "more names of quantities, as in omega_1 = ['n_EM1'] (repeatable)", Path, metavar="FILE.toml"
    )

    @property
    def as_read(self) -> dict[str, Any]:
        """How `read_drive` and `read_measurement` are to read it."""
        by_quantity: dict[str, str] = {}
        for quantity, heading in self.column:
            if by_quantity.setdefault(quantity, heading) != heading:
                raise UserError(f"--column {quantity}: {by_quantity[quantity]} and {heading} are given; it can be one")
        cut = Cut(self.from_, self.to)
        return {"columns": by_quantity, "names": self.aliases, "databases": self.dbc, "cut": cut}
