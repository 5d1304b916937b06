"""How a text separates its cells, writes its numbers, and where its names, units and numbers begin."""

import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass
from io import StringIO
from itertools import islice, zip_longest
from pathlib import Path
from statistics import median

import numpy as np

from toolground.unit_conversion import known

from .cells import decimal_of, is_missing, is_number, numbers, unquoted
from .clock_times import is_clock_time
from .source import RecordingError

SEPARATORS = ("\t", ";", ",", "|", "~", "^", "\x1f", " ")
"""Blanks, of any number, separate where nothing else does."""

LOOKED_AT = 500
"""Rows at the beginning of the file that tell its dialect."""

EXCEL = re.compile(r"sep=(?P<separator>.)\s*\n")
"""A first line that spreadsheets write and obey."""

# numpy writes # before the names, an INI has ; there; below the names of Markdown stands | --- | ---: |
COMMENT, LINE = re.compile(r"\s*(?P<mark>[#%!;*]+|//+|--+\s|REM\s)\s*"), re.compile(r"[-=_+:|*\s]*")
"""With which a comment or a line of names may begin, and a line that only parts others."""

TIMES = frozenset(("s", "ms"))

EVEN = 1.2
"""Longest over shortest step of what is a time, and not a speed that grows."""

Row = tuple[int, list[str]]
"""Number of its last line in the file, and its cells."""


@dataclass(frozen=True)
class Dialect:
    """
    Attributes:
        decimal: point or comma.
        names: the cells of the line of names.
        units: those of the line of units below it; none if there is no such line.
        clocks: for each column whether its first cell is a time of day or a duration.
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

    def names_others(self, line: str) -> bool:
        """Whether a line among the numbers names columns too, and not the same ones."""
        first, *rest = (unquoted(cell.strip()) for cell in line.split(self.separator))
        cells = [*filter(None, (COMMENT.sub("", first, count=1).strip(), *rest))]
        # the same names again, behind a comment mark or with an empty end, are those of a new page
        names = [*filter(None, self.names)]
        return cells != names and sum(name in cells for name in names) > 1

    def is_note(self, line: str) -> bool:
        """Whether a line among the numbers is a comment, or the name of an event."""
        first = line.partition(self.separator)[0]
        text = line.strip(f"{self.separator} \t")
        is_row = self.separator in text or text[:1].isdecimal() or is_number(text)
        return not is_row or is_comment(first, self.separator)


def is_comment(first: str, separator: str) -> bool:
    """Whether a row is one by its first cell. A mark alone, or at a number, may be that of an event in the row; before
    a blank that separates it is none. What says that a value is missing, as #N/A, begins none."""
    mark = COMMENT.match(first)
    if not mark or separator == " ":
        return mark is not None
    # rows that begin with #N/A were taken for comments
    if is_missing(first):
        return False
    rest = first[mark.end("mark") :].rstrip()
    return bool(rest) and (rest != rest.lstrip() or not is_number(rest))


def dialect_of(text: str, path: Path) -> Dialect:
    """Separator: the one with which the first rows have most numbers each. Names: the last row without a number
    above the first row of numbers, but for a row that holds units alone.

    Args:
        path: of the file, for messages.

    Raises:
        RecordingError: there is no row of names; a cell is longer than any can be.
    """
    excel = EXCEL.match(text)
    separators = excel["separator"] if excel else SEPARATORS
    rows_by = {separator: _rows(text, separator, path) for separator in separators}
    separator = max(rows_by, key=lambda separator: _likely(separator, rows_by[separator]))
    rows = rows_by[separator][1:] if excel else rows_by[separator]
    if not rows:
        raise RecordingError(f"{path} is empty")
    above, below = _parted(rows, separator)
    width = max((len(cells) for _, cells in below), default=0)
    above = [(line, [unquoted(cell.strip()) for cell in _uncommented(cells, width)]) for line, cells in above]
    if above and _has_index(above[-1][1], below, path):
        above = [(line, ["", *cells]) for line, cells in above]
    if not above:
        raise RecordingError(f"{path}, line {rows[0][0]}: there is no line of names above the numbers")
    of_units = (k for k in range(len(above) - 1, 0, -1) if _are_units(above[k][1], above[k - 1][1]))
    if k := next(of_units, 0):
        (names_line, names), units = above[k - 1], above[k][1]
    else:
        (names_line, names), units = above[-1], ()
    if separator == "," and _is_decimal_too(names, [cells for _, cells in below]):
        raise RecordingError(
            f"{path}, line {below[0][0]} has {len(below[0][1])} cells below {_filled(names)} names: the comma parts "
            "cells and decimals; save it with semicolons or decimal points"
        )
    columns = list(zip_longest(*(cells for _, cells in below), fillvalue=""))
    firsts = (next((cell for cell in column if not is_missing(cell)), "") for column in columns)
    clocks = tuple(not is_number(cell) and is_clock_time(cell) for cell in firsts)
    decimal = decimal_of(*columns)
    return Dialect(separator, decimal, tuple(names), tuple(units), clocks, names_line, above[-1][0] + 1)


def _has_index(names: Sequence[str], rows: Sequence[Row], path: Path) -> bool:
    """Whether the numbers of the rows stand before them without a name, as R writes them: in quotes, or before a time.

    Raises:
        RecordingError: they may as well be the first column that has a name, and the last is the one without.
    """
    if len(rows) < 2 or any(_filled(cells) != len(names) + 1 for _, cells in rows):
        return False
    counted, behind = ([cells[k].strip() for _, cells in rows] for k in (0, 1))
    first = unquoted(counted[0])
    if not (first.isascii() and first.isdecimal()):
        return False
    if [unquoted(cell) for cell in counted] != [str(k) for k in range(int(first), int(first) + len(rows))]:
        return False
    if counted[0] != first or all(map(is_clock_time, behind)):
        return True
    # rows counted from 1 may be the time in ms, unless what is behind goes on as evenly as a time
    steps = np.diff(numbers(behind, decimal_of(behind))[0])
    if not 0.0 < steps.max() < EVEN * steps.min():
        raise RecordingError(
            f"{path}, line {rows[0][0]} has {len(names) + 1} cells below {len(names)} names, and the first counts the "
            "rows: it may be any that lacks a name; name them all"
        )
    return True


def _is_decimal_too(names: Sequence[str], rows: Sequence[Sequence[str]]) -> bool:
    """Whether the comma that separates cells stands in numbers too, without quotes."""
    # 36,5 and 0,1 in three columns made six, and the speed 36 came into the place of the time
    wider = [sum(map(is_number, cells)) > _filled(names) for cells in rows]
    return 2 * sum(wider) > len(rows) and not any("." in cell or "," in cell for cells in rows for cell in cells)


def _uncommented(cells: Sequence[str], width: int) -> Sequence[str]:
    """Without a mark of a comment before them; one over a column of its own, as that of a number of the row, stays.

    Args:
        width: cells in the rows of numbers.
    """
    # a column of row numbers headed # lost its name, which moved all other names by one in silence
    first = [COMMENT.sub("", cell, count=1) if not k else cell for k, cell in enumerate(cells)]
    return first[1:] if len(first) > width and not first[0] and cells[0] else first


def _rows(text: str, separator: str, path: Path) -> list[Row]:
    """The first rows in which something stands."""
    reader = csv.reader(StringIO(text, newline=""), delimiter=separator, skipinitialspace=separator == " ")
    try:
        return [
            (reader.line_num, cells)
            for cells in islice(reader, LOOKED_AT)
            if any(map(str.strip, cells)) and not all(map(LINE.fullmatch, cells))
        ]
    except csv.Error as error:
        raise RecordingError(f"{path} is no CSV file: {error}") from error


def _likely(separator: str, rows: Sequence[Row]) -> tuple[float, float]:
    """Numbers in one of the last rows, on average; without any number, cells."""
    last_rows = _last(rows)
    numbers = sum(map(_numbers, last_rows)) / max(len(last_rows), 1)
    return numbers, 0.0 if numbers or separator == " " else sum(map(len, last_rows)) / max(len(last_rows), 1)


def _last(rows: Sequence[Row]) -> list[list[str]]:
    """The cells of the last third of some rows, which is below any head."""
    return [cells for _, cells in rows[-(1 + len(rows) // 3) :]]


def _numbers(cells: Sequence[str]) -> int:
    """How many there are; where there is one, what stands for a missing one counts too."""
    there = sum(map(is_number, cells))
    return there + sum(is_missing(cell) for cell in cells if cell and cell != ",") if there else 0


def _parted(rows: Sequence[Row], separator: str) -> tuple[Sequence[Row], Sequence[Row]]:
    """The rows above the numbers, and those from the first one after the last of them.

    A row of numbers has more than half of the cells that are usual, half of them numbers or more, and so has the row
    after it. It begins as most of the last rows do, and not as a comment. Others above it, such as the rate of the
    recording, are no names if a number is among them.
    """
    last_rows = _last(rows)
    # a preamble has rate, date and number of the bench, in fewer cells
    usual = median(map(_filled, last_rows))
    begins = 2 * sum(_numbers(cells[:1]) for cells in last_rows) > len(last_rows)
    numeric = [
        2 * _numbers(cells) >= _filled(cells) > 0.5 * usual
        and not is_comment(cells[0], separator)
        and bool(_numbers(cells[:1]) or is_missing(cells[0]) or not begins)
        for _, cells in rows
    ] + [True]
    first = next((k for k in range(len(rows)) if numeric[k] and numeric[k + 1]), len(rows))
    last = max((k for k in range(first) if not _numbers(rows[k][1])), default=-1)
    if first == len(rows):
        last = min(last, 0)
    return rows[: last + 1], rows[last + 1 :]


def _filled(cells: Sequence[str]) -> int:
    return sum(bool(cell.strip()) for cell in cells)


def _are_units(cells: Sequence[str], names: Sequence[str]) -> bool:
    """Whether a row below names holds units, for each name one or nothing. If one is that of a time, two
    thirds of them may be none, as `enum`."""
    # with a word such as enum for a gear the line of units was taken for the names
    units = {k: unit for k, cell in enumerate(cells) if (unit := cell.strip(" []()"))}
    named = all(k < len(names) and names[k].strip() for k in units)
    none = [unit for unit in units.values() if not known(unit)]
    return bool(units and named) and 3 * len(none) <= 2 * len(units) * (not TIMES.isdisjoint(units.values()))
