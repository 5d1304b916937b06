"""How a text file separates its cells, writes its numbers, and where its names, units and numbers begin."""

import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass
from io import StringIO
from itertools import islice
from pathlib import Path
from statistics import median

from .clock_times import is_clock_time
from .recording_units import is_unit
from .source import RecordingError

SEPARATORS = ("\t", ";", ",")

LOOKED_AT = 100
"""Rows at the beginning of the file that tell its dialect."""

NUMBER = re.compile(r"\s*[+-]?(\d+[.,]?\d*|[.,]\d+)(e[+-]?\d+)?\s*", re.ASCII | re.IGNORECASE)

EXCEL = re.compile(r"sep=(?P<separator>.)\s*\n")
"""A first line that spreadsheets write and obey."""

Row = tuple[int, list[str]]
"""Number of its last line in the file, and its cells."""


@dataclass(frozen=True)
class Dialect:
    """
    Attributes:
        decimal: point or comma.
        names: the cells of the line of names.
        units: those of the line of units below it; none if there is no such line.
        clocks: for each cell of the first row of numbers whether it is a time of day.
        names_line: number of the line of names.
        first_line: number of the line with which the numbers begin.
    """

    separator: str
    decimal: str
    names: tuple[str, ...]
    units: tuple[str, ...]
    clocks: tuple[bool, ...]
    names_line: int
    first_line: int


def dialect_of(text: str, path: Path) -> Dialect:
    """Separator: the one with which the first rows have most numbers each. Names: the last row without a number
    above the first row of numbers, but for a row that holds units alone.

    Args:
        path: of the file, for messages.

    Raises:
        RecordingError: there is no row of names; a cell is longer than any can be.
    """
    excel = EXCEL.match(text)
    found = {separator: _rows(text, separator, path) for separator in (excel["separator"] if excel else SEPARATORS)}
    separator = max(found, key=lambda separator: _likely(found[separator]))
    rows = found[separator][1:] if excel else found[separator]
    if not rows:
        raise RecordingError(f"{path} is empty")
    above, below = _parted(rows)
    if not above:
        raise RecordingError(f"{path}, line {rows[0][0]}: there is no line of names above the numbers")
    names_line, names = above[-1]
    units_line, units = names_line, ()
    if len(above) > 1 and _are_units(names, above[-2][1]):
        (names_line, names), (units_line, units) = above[-2], above[-1]
    clocks = tuple(is_clock_time(cell) for cell in below[0][1]) if below else ()
    return Dialect(
        separator, _decimal(separator, below), tuple(names), tuple(units), clocks, names_line, units_line + 1
    )


def _rows(text: str, separator: str, path: Path) -> list[Row]:
    """The first rows in which something stands."""
    reader = csv.reader(StringIO(text, newline=""), delimiter=separator)
    try:
        return [(reader.line_num, cells) for cells in islice(reader, LOOKED_AT) if any(map(str.strip, cells))]
    except csv.Error as error:
        raise RecordingError(f"{path} is no CSV file: {error}") from error


def _likely(rows: Sequence[Row]) -> tuple[float, float]:
    """Numbers in a row, on average; without any number, cells."""
    numbers = sum(_numbers(cells) for _, cells in rows) / max(len(rows), 1)
    return numbers, 0.0 if numbers else sum(len(cells) for _, cells in rows) / max(len(rows), 1)


def _numbers(cells: Sequence[str]) -> int:
    return sum(NUMBER.fullmatch(cell) is not None for cell in cells)


def _parted(rows: Sequence[Row]) -> tuple[Sequence[Row], Sequence[Row]]:
    """The rows above the numbers, and those from the first one after the last of them.

    A row of numbers has more than half of the cells that are usual, half of them numbers or more, and so has the row
    after it. Others above it, such as the rate of the recording, are no names if a number is among them.
    """
    usual = median(_filled(cells) for _, cells in rows)
    numeric = [2 * _numbers(cells) >= _filled(cells) > 0.5 * usual for _, cells in rows] + [True]
    first = next((k for k in range(len(rows)) if numeric[k] and numeric[k + 1]), len(rows))
    last = max((k for k in range(first) if not _numbers(rows[k][1])), default=-1)
    if first == len(rows):
        last = min(last, 0)
    return rows[: last + 1], rows[last + 1 :]


def _filled(cells: Sequence[str]) -> int:
    return sum(bool(cell.strip()) for cell in cells)


def _are_units(cells: Sequence[str], names: Sequence[str]) -> bool:
    """Whether a row below names holds units, for each name one or nothing."""
    units = [cell.strip(" []()") for cell in cells]
    named = [bool(name.strip()) for name in names]
    return any(units) and all(
        not unit or (k < len(named) and named[k] and is_unit(unit)) for k, unit in enumerate(units)
    )


def _decimal(separator: str, rows: Sequence[Row]) -> str:
    """Point or comma: what most numbers of the rows have. Where the comma separates, it can do both in quotes."""
    numbers = [cell for _, cells in rows for cell in cells if NUMBER.fullmatch(cell)]
    return "," if sum("," in number for number in numbers) > sum("." in number for number in numbers) else "."
