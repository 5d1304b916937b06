"""Text files of numbers, parsed by pandas: it reads what spreadsheets and loggers quote and leave out, and the readers
of the other formats are made for it too."""

import codecs
import csv
import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from io import StringIO
from math import isfinite
from pathlib import Path
from typing import TextIO

import numpy as np

from ...fmus.file_limits import LARGEST_NOTE, LARGEST_TEXT, LONGEST_LINE, MOST_COLUMNS
from ..base.plain_text import plain
from ..base.written_numbers import real
from .clock_times import EXAMPLES, seconds
from .dialect import Dialect, dialect_of
from .headings import split
from .source import Column, RecordingError, Samples, Where, not_finite

LONGEST_CELL = 60
"""Characters of a cell that are shown."""

PLAIN_NUMBERS = frozenset("0123456789+-.eE")

TRUTHS = ("true", "false")
"""What pandas takes for numbers."""

PIECE = 4_000_000
"""Characters that are parsed at a time."""


class TextFile:
    """A Source. Its lines are counted from 1, as an editor does."""

    own_time = False

    def __init__(self, path: Path) -> None:
        """
        Raises:
            RecordingError: it is no text, or has no line of names; it is larger than any recording.
        """
        self.path = path
        if (size := path.stat().st_size) > LARGEST_TEXT:
            raise RecordingError(
                f"{path} has {size / 1e6:.0f} MB; a text is read up to {LARGEST_TEXT / 1e6:.0f} MB, larger recordings "
                "as Parquet or MDF"
            )
        self._encoding = encoding_of(path)
        self._dialect = dialect_of(self._head(), path)
        self.headings = f"{path}, line {self._dialect.names_line}"
        if len(self._dialect.names) > MOST_COLUMNS:
            raise self._too_wide(self._dialect.names_line, len(self._dialect.names))
        self.columns: Sequence[Column] = _columns(self._dialect, units_beside(path))

    def read(self, places: Sequence[int]) -> list[Samples]:
        """See `harness.recordings.source.Source.read`; lines in which nothing stands are passed over."""
        blank = "\t " + self._dialect.separator
        pieces: dict[int, list[np.ndarray]] = {place: [] for place in places}
        numbers: list[np.ndarray] = []
        for first, lines in self._pieces():
            kept = [k for k, line in enumerate(lines) if line.strip(blank)]
            at = first + np.array(kept, dtype=int)
            for place, values in self._parsed([lines[k] for k in kept], places, at).items():
                pieces[place].append(values)
            numbers.append(at)
        where = Where("line {1}", np.concatenate([*numbers, np.empty(0, dtype=int)]))
        whole = {place: np.concatenate([*pieces[place], np.empty(0)]) for place in places}
        return [Samples(self._values(whole[place], place, where), None, where) for place in places]

    def _values(self, cells: np.ndarray, place: int, where: Callable[[int], str]) -> np.ndarray:
        """The numbers of a column; times in s.

        Raises:
            RecordingError: in a column of times of day one is no such time.
        """
        if not _is_clock(self._dialect, place):
            return cells
        values = seconds(cells.tolist())
        if isinstance(values, int):
            cell = plain(cells[values], LONGEST_CELL) or "an empty cell"
            raise RecordingError(
                f"{self.path}, {where(values)}, column {self.columns[place].heading}: {cell} is no time as in the "
                f"first row, such as {EXAMPLES}"
            )
        return values

    @contextmanager
    def _text(self) -> Iterator[TextIO]:
        """The text, its lines ended by one line feed each."""
        try:
            with self.path.open(encoding=self._encoding) as file:
                yield file
        except UnicodeDecodeError as error:
            raise RecordingError(f"{self.path} is no text: {error.reason}") from error

    def _head(self) -> str:
        """Whole lines at the beginning."""
        with self._text() as file:
            head = file.read(3 * LONGEST_LINE) + file.readline(LONGEST_LINE + 1)
        self._require_short(head.split("\n"), 1)
        return head

    def _pieces(self) -> Iterator[tuple[int, list[str]]]:
        """The lines below the names, some at a time, and the number of the first of them in the file."""
        number = self._dialect.first_line
        with self._text() as file:
            for _ in range(1, number):
                file.readline()
            while piece := file.read(PIECE):
                lines = (piece + file.readline(LONGEST_LINE + 1)).removesuffix("\n").split("\n")
                self._require_short(lines, number)
                yield number, lines
                number += len(lines)

    def _parsed(self, lines: Sequence[str], places: Sequence[int], at: np.ndarray) -> dict[int, np.ndarray]:
        """The numbers in some columns of lines; of times of day the cells.

        Args:
            at: the numbers of the lines in the file.
        """
        if not lines:
            return {place: np.empty(0) for place in places}
        widths = [line.count(self._dialect.separator) for line in lines]
        widest = max(len(self.columns), 1 + max(widths))
        if widest > MOST_COLUMNS:
            raise self._too_wide(int(at[int(np.argmax(widths))]), widest)
        clocks = [place for place in places if _is_clock(self._dialect, place)]
        numbers = [place for place in places if place not in clocks]
        values = self._all_numbers(lines, numbers, widest) if numbers else {}
        if values is not None and not clocks:
            return values
        try:
            cells = self._table(lines, places if values is None else clocks, widest, str)
            if all(len(column) == len(lines) for column in cells.values()):
                values = values or {
                    place: self._numbers(cells[place], self.columns[place], lambda k: f"line {at[k]}")
                    for place in numbers
                }
                return values | {place: cells[place] for place in clocks}
            self._refuse_many_lines(lines, at)
            problem = "a quote has no end"
        except (ValueError, csv.Error) as error:
            problem = plain(error)
        raise RecordingError(f"{self.path} is no CSV file: {problem}")

    def _all_numbers(self, lines: Sequence[str], places: Sequence[int], widest: int) -> dict[int, np.ndarray] | None:
        """The numbers, found all at once; None if something else is, or may be, among them."""
        text = "\n".join(lines).lower()
        if self._dialect.decimal == self._dialect.separator or any(truth in text for truth in TRUTHS):
            return None
        try:
            values = self._table(lines, places, widest, float)
        except ValueError:
            return None
        sound = all(len(column) == len(lines) and np.isfinite(column).all() for column in values.values())
        return values if sound else None

    def _table(
        self, lines: Sequence[str], places: Sequence[int], widest: int, kind: type[float | str]
    ) -> dict[int, np.ndarray]:
        """
        Raises:
            ValueError: a cell is none of that kind, or there is a quote without an end.
        """
        import pandas as pd  # takes most of a second

        separator = self._dialect.separator
        first = separator.join("0" * widest)  # says how many cells there can be
        table = pd.read_csv(
            StringIO("\n".join([first, *lines])),
            sep=separator,
            decimal=self._dialect.decimal if kind is float else ".",
            header=None,
            usecols=list(places),
            index_col=False,
            dtype=kind,
            na_filter=False,
            skip_blank_lines=False,
            engine="c",
        )
        return {place: table[place].to_numpy()[1:] for place in places}

    def _refuse_many_lines(self, lines: Sequence[str], at: np.ndarray) -> None:
        """Names a cell that goes over several lines, as only quoted ones can."""
        reader, before = csv.reader(StringIO("\n".join(lines), newline=""), delimiter=self._dialect.separator), 0
        for row in reader:
            if reader.line_num > before + 1:
                place = next((k for k, cell in enumerate(row) if "\n" in cell), len(row) - 1)
                named = self.columns[place].heading if place < len(self.columns) else f"number {place + 1}"
                raise RecordingError(
                    f"{self.path}, line {at[before]}, column {named}: "
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

    def _require_short(self, lines: Sequence[str], first: int) -> None:
        """
        Args:
            first: number of the first of them in the file.
        """
        for number, line in enumerate(lines, first):
            if len(line) > LONGEST_LINE:
                raise RecordingError(f"{self.path}, line {number} has more than {LONGEST_LINE} characters")

    def _too_wide(self, line: int, cells: int) -> RecordingError:
        return RecordingError(f"{self.path}, line {line} has {cells} cells; at most {MOST_COLUMNS} are read")


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


MARKS = (
    # that of UTF-16 is the beginning of one of UTF-32
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)

LOOKED_AT = 1000
"""Bytes at the beginning that tell UTF-16 and UTF-32 without a mark from the others: every other one of them is zero,
or three of four."""


def encoding_of(path: Path) -> str:
    """UTF-8, UTF-16 or UTF-32, with or without their mark; Latin-1, in which every byte is a character, if none."""
    with path.open("rb") as file:
        head = file.read(LOOKED_AT)
        for mark, name in MARKS:
            if head.startswith(mark):
                return name
        if len(head) > 3 and head.count(0) > 2 * len(head) // 3:
            return "utf-32-be" if head[0] == 0 else "utf-32-le"
        if len(head) > 1 and head.count(0) > len(head) // 3:
            return "utf-16-le" if head[1::2].count(0) > head[::2].count(0) else "utf-16-be"
        decoder, piece = codecs.getincrementaldecoder("utf-8")(), head
        try:
            while piece:
                decoder.decode(piece)
                piece = file.read(PIECE)
            decoder.decode(b"", final=True)
        except UnicodeDecodeError:
            return "latin-1"
    return "utf-8"


def units_beside(path: Path) -> dict[str, str]:
    """Unit by column of a file of results; nothing if no record beside it tells of this file.

    The record of several files has the beginning of their names, as trip.json has of trip_off.csv.
    """
    stem = path.stem
    while stem:
        record = path.with_name(f"{stem}.json")
        try:
            read = record.is_file() and record.stat().st_size <= LARGEST_NOTE
            content = json.loads(record.read_text(encoding="utf-8")) if read else {}
            if path.name in content["files"]:
                return {str(name): str(unit) for name, unit in content["units"].items()}
        except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
            pass  # there is none, or it is something else
        stem = stem.rpartition("_")[0]
    return {}
