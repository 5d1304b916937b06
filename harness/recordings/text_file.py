"""Text files of numbers, parsed by pandas: it reads what spreadsheets and loggers quote and leave out, and the readers
of the other formats are made for it too."""

import codecs
import csv
import json
from collections.abc import Callable, Sequence
from io import StringIO
from math import isfinite
from pathlib import Path

import numpy as np

from ..base.plain_text import plain
from ..base.written_numbers import real
from .clock_times import EXAMPLES, seconds
from .dialect import Dialect, dialect_of
from .headings import split
from .source import Column, RecordingError, Samples, not_finite

LONGEST_CELL = 60
"""Characters of a cell that are shown."""

PLAIN_NUMBERS = frozenset("0123456789+-.eE")


class TextFile:
    """A Source. Its lines are counted from 1, as an editor does."""

    own_time = False

    def __init__(self, path: Path) -> None:
        """
        Raises:
            RecordingError: it is no text, or has no line of names.
        """
        self.path = path
        try:
            self._text = decoded(path.read_bytes())
        except UnicodeDecodeError as error:
            raise RecordingError(f"{path} is no text: {error.reason} at byte {error.start}") from error
        self._dialect = dialect_of(self._text, path)
        self.headings = f"{path}, line {self._dialect.names_line}"
        self.columns: Sequence[Column] = _columns(self._dialect, units_beside(path))

    def read(self, places: Sequence[int]) -> list[Samples]:
        """See `harness.recordings.source.Source.read`; lines in which nothing stands are passed over."""
        first = self._dialect.first_line
        lines = self._text.split("\n")[first - 1 :]
        blank = "\t " + self._dialect.separator
        kept = np.array([k for k, line in enumerate(lines) if line.strip(blank)], dtype=int)
        cells = self._cells(lines, places)

        def where(k: int) -> str:
            return f"line {first + kept[k]}"

        return [
            Samples(self._values(np.asarray(cells[place], dtype=object)[kept], place, where), None, where)
            for place in places
        ]

    def _values(self, cells: np.ndarray, place: int, where: Callable[[int], str]) -> np.ndarray:
        """
        Raises:
            RecordingError: one is no number; in a column of times of day, no such time.
        """
        column = self.columns[place]
        if not _is_clock(self._dialect, place):
            return self._numbers(cells, column, where)
        values = seconds(cells.tolist())
        if isinstance(values, int):
            cell = plain(cells[values], LONGEST_CELL) or "nothing"
            raise RecordingError(
                f"{self.path}, {where(values)}, column {column.heading}: {cell} is no time as in the first row, "
                f"such as {EXAMPLES}"
            )
        return values

    def _cells(self, lines: Sequence[str], places: Sequence[int]) -> dict[int, list[str]]:
        """Of some columns, one for every line."""
        import pandas as pd  # takes most of a second

        separator = self._dialect.separator
        widest = max(len(self.columns), 1 + max(line.count(separator) for line in lines))
        try:
            table = pd.read_csv(
                StringIO(
                    "\n".join([separator * (widest - 1), *lines])
                ),  # the first row says how many cells there can be
                sep=separator,
                header=None,
                usecols=list(places),
                index_col=False,
                dtype=str,
                na_filter=False,
                skip_blank_lines=False,
                engine="c",
            )
        except pd.errors.ParserError as error:
            raise RecordingError(f"{self.path} is no CSV file: {plain(error)}") from error
        if len(table) - 1 + (not lines[-1]) != len(lines):
            self._refuse_many_lines(lines)
        return {place: [*table[place].tolist()[1:], ""] for place in places}

    def _refuse_many_lines(self, lines: Sequence[str]) -> None:
        """Names a cell that goes over several lines, as only quoted ones can."""
        reader, before = csv.reader(StringIO("\n".join(lines), newline=""), delimiter=self._dialect.separator), 0
        for row in reader:
            if reader.line_num > before + 1:
                place = next((k for k, cell in enumerate(row) if "\n" in cell), len(row) - 1)
                named = self.columns[place].heading if place < len(self.columns) else f"number {place + 1}"
                raise RecordingError(
                    f"{self.path}, line {self._dialect.first_line + before}, column {named}: "
                    f"{plain(row[place], LONGEST_CELL)} is a cell over several lines"
                )
            before = reader.line_num

    def _numbers(self, cells: np.ndarray, column: Column, where: Callable[[int], str]) -> np.ndarray:
        """
        Raises:
            RecordingError: one is not a finite number.
        """
        decimal = self._dialect.decimal
        texts = [cell.strip().replace(",", ".") for cell in cells] if decimal == "," else [c.strip() for c in cells]
        if PLAIN_NUMBERS.issuperset("".join(texts)) and (decimal == "." or not any("." in cell for cell in cells)):
            try:
                values = np.array(texts, dtype=float)  # the same numbers, all at once
            except ValueError:
                pass
            else:
                if np.isfinite(values).all():
                    return values
        for k, cell in enumerate(cells):
            value = real(texts[k])
            if value is None or not isfinite(value) or (decimal == "," and "." in cell):
                refusal = not_finite(self.path, where(k), column, plain(cell, LONGEST_CELL))
                raise RecordingError(f"{refusal}, nor a time such as {EXAMPLES}") if ":" in cell else refusal
        return np.array(texts, dtype=float)


def _columns(dialect: Dialect, beside: dict[str, str]) -> list[Column]:
    """The columns with their units: beside the name, in the line below it, or in the file beside results of ours."""
    columns = []
    for k, cell in enumerate(dialect.names):
        name, unit = split(cell)
        below = dialect.units[k].strip(" []()") if k < len(dialect.units) else ""
        own = "s" if _is_clock(dialect, k) else unit or below or beside.get(name)
        columns.append(Column(plain(cell, LONGEST_CELL), plain(name, LONGEST_CELL), own))
    return columns


def _is_clock(dialect: Dialect, place: int) -> bool:
    return place < len(dialect.clocks) and dialect.clocks[place]


MARKS = ((codecs.BOM_UTF8, "utf-8-sig"), (codecs.BOM_UTF16_LE, "utf-16"), (codecs.BOM_UTF16_BE, "utf-16"))

LOOKED_AT = 1000
"""Bytes at the beginning that tell UTF-16 without a mark from the others: every other one of them is zero."""


def encoding_of(content: bytes) -> str:
    """UTF-8 or UTF-16, with or without the mark of either; Latin-1, in which every byte is a character, if neither."""
    for mark, name in MARKS:
        if content.startswith(mark):
            return name
    head = content[:LOOKED_AT]
    if len(head) > 1 and head.count(0) > len(head) // 3:
        return "utf-16-le" if head[1::2].count(0) > head[::2].count(0) else "utf-16-be"
    try:
        content.decode("utf-8")
    except UnicodeDecodeError:
        return "latin-1"
    return "utf-8"


def decoded(content: bytes) -> str:
    """The text, its lines ended by one line feed each.

    Raises:
        UnicodeDecodeError: it is damaged UTF-16.
    """
    return content.decode(encoding_of(content)).replace("\r\n", "\n").replace("\r", "\n")


def units_beside(path: Path) -> dict[str, str]:
    """Unit by column of a file of results; nothing if no record beside it tells of this file.

    The record of several files has the beginning of their names, as trip.json has of trip_off.csv.
    """
    stem = path.stem
    while stem:
        record = path.with_name(f"{stem}.json")
        try:
            content = json.loads(record.read_text(encoding="utf-8"))
            if path.name in content["files"]:
                return {str(name): str(unit) for name, unit in content["units"].items()}
        except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
            pass  # there is none, or it is something else
        stem = stem.rpartition("_")[0]
    return {}
