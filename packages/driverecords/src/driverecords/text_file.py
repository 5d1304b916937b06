"""Text files of numbers, parsed by pandas: it reads what spreadsheets and loggers quote and leave out, and the readers
of the other formats are made for it too."""

import codecs
import csv
import json
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from io import StringIO
from pathlib import Path
from typing import NamedTuple, TextIO

import numpy as np

from toolground.collected_warnings import warn_once
from toolground.file_limits import LARGEST_NOTE, LARGEST_TEXT, LONGEST_LINE, MOST_COLUMNS
from toolground.plain_text import plain
from toolground.unit_conversion import converts, factor

from .cells import SPELLINGS, TRUTHS, is_missing, numbers
from .clock_times import seconds
from .dialect import Dialect, dialect_of
from .headings import split
from .logger_dialects import logger_dialect
from .source import Column, RecordingError, Samples, Where

LONGEST_CELL = 60
"""Characters of a cell that are shown."""

DIGIT = re.compile(r"\d", re.ASCII)

PADDING = "\x00\x1a\xff\ufffd"
"""What some write behind the last line, and before the next after a loss of power."""

CONTROLS = re.compile("[\x01-\x08\x0e-\x19\x1c-\x1e]")
"""Characters that no text has."""

WHOLE = re.compile(r'"((?:[^"]|"")*)"\s*')
"""A line in quotes: spreadsheets write it so of a text that they have not parted into cells."""

# at once an hour at 1 kHz took 2.1 GB and 48 s, in pieces 0.6 GB and 11 s
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
        head = self._head()
        if CONTROLS.search(head):
            raise RecordingError(f"{path} is no text, and of no other kind that is read")
        lines = head.split("\n", 20)[:-1]
        self._in_quotes = len(lines) > 1 and all(WHOLE.fullmatch(line) for line in lines if line.strip())
        head = "\n".join(map(self._unquoted, head.split("\n")))
        self._dialect = logger_dialect(head, path) or dialect_of(head, path)
        self.headings = f"{path}, line {self._dialect.names_line}"
        if len(self._dialect.names) > MOST_COLUMNS:
            raise self._too_wide(self._dialect.names_line, len(self._dialect.names))
        self.columns: Sequence[Column] = _columns(self._dialect, units_beside(path))

    def read(self, places: Sequence[int]) -> list[Samples]:
        """See `driverecords.source.Source.read`; lines without a number in these columns are passed over."""
        pieces: list[Piece] = [
            piece for first, lines in self._pieces() for piece in [self._parsed(lines, places, first)]
        ]
        where = Where("line {1}", np.concatenate([*(piece.at for piece in pieces), np.empty(0, dtype=int)]))
        begins = np.cumsum([0, *(len(piece.at) for piece in pieces)])
        read = []
        for place in places:
            values = np.concatenate([*(piece.values[place] for piece in pieces), np.empty(0)])
            refused = (piece.unreadable.get(place, {}) for piece in pieces)
            unreadable = {int(b) + k: cell for b, of in zip(begins, refused, strict=False) for k, cell in of.items()}
            read.append(
                self._clock(values, where) if self._is_clock(place) else Samples(values, None, where, unreadable)
            )
        return read

    def _clock(self, cells: np.ndarray, where: Callable[[int], str]) -> Samples:
        """Times in s, of times of day or durations."""
        values, begin = seconds(cells.tolist())
        odd = np.flatnonzero(np.isnan(values))
        unreadable = {int(k): cells[k] for k in odd if not is_missing(cells[k])}
        return Samples(values, None, where, unreadable, begin)

    @contextmanager
    def _text(self) -> Iterator[TextIO]:
        """The text, its lines ended by one line feed each."""
        try:
            with self.path.open(encoding=self._encoding, errors="replace") as file:  # the last character may be cut off
                yield file
        except UnicodeError as error:
            raise RecordingError(f"{self.path} is no text: {error}") from error

    def _unquoted(self, line: str) -> str:
        match = WHOLE.fullmatch(line) if self._in_quotes else None
        return match[1].replace('""', '"') if match else line

    def _head(self) -> str:
        """Whole lines at the beginning."""
        with self._text() as file:
            head = file.read(3 * LONGEST_LINE) + file.readline(LONGEST_LINE + 1)
        self._require_short(head.split("\n"), 1)
        return head

    def _pieces(self) -> Iterator[tuple[int, list[str]]]:
        """The lines below the names, some at a time, and the number of the first of them in the file. A last line that
        was cut off is left out."""
        number, separator = self._dialect.first_line, self._dialect.separator
        with self._text() as file:
            for _ in range(1, number):
                file.readline()
            while piece := file.read(PIECE):
                lines = (piece + (end := file.readline(LONGEST_LINE + 1))).split("\n")
                self._require_short(lines, number)
                lines = [*map(self._unquoted, lines)] if self._in_quotes else lines
                if lines[-1] and not end and _is_cut_off([line.rstrip(PADDING) for line in lines[-10:]], separator):
                    if DIGIT.search(lines[-1]):
                        warn_once(f"{self.path}: the last line was cut off and is left out")
                    lines[-1] = ""
                if not lines[-1]:
                    del lines[-1]
                yield number, [" ".join(line.split()) for line in lines] if separator == " " else lines
                number += len(lines)

    def _parsed(self, lines: Sequence[str], places: Sequence[int], first: int) -> "Piece":
        """Some columns of lines.

        Args:
            first: number of the first of them in the file.
        """
        separator = self._dialect.separator
        blank = f"\t {separator}{PADDING}"
        kept = [k for k, line in enumerate(lines) if line.strip(blank)]
        lines, at = [lines[k].strip(PADDING) for k in kept], first + np.array(kept, dtype=int)
        if not lines:
            return Piece(at, {place: np.empty(0) for place in places}, {})
        widths = [line.count(separator) for line in lines]
        widest = max(len(self.columns), 1 + max(widths))
        if widest > MOST_COLUMNS:
            raise self._too_wide(int(at[int(np.argmax(widths))]), widest)
        clocks = [place for place in places if self._is_clock(place)]
        plain_numbers = [place for place in places if place not in clocks]
        values = self._all_numbers(lines, plain_numbers, widest) if plain_numbers else {}
        if values is not None and not clocks:
            return Piece(at, values, {})
        cells = self._cells(lines, places, widest)
        return (
            Piece(at, values | {place: cells[place] for place in clocks}, {})
            if values
            else self._told_apart(cells, lines, at)
        )

    def _told_apart(self, cells: Mapping[int, np.ndarray], lines: Sequence[str], at: np.ndarray) -> "Piece":
        """Numbers, what says that there is none, and what cannot be read; without lines of names and comments, and
        those in which no digit is."""
        values, unreadable = {}, {}
        names = np.ones(len(at), dtype=bool)
        for place, column in cells.items():
            names &= column == self._dialect.names[place] if place < len(self._dialect.names) else False
        digits = [any(map(DIGIT.search, row)) for row in zip(*cells.values(), strict=True)]
        kept = np.array(digits) & ~names & ~np.array([*map(self._dialect.is_note, lines)])
        for k in np.flatnonzero(~np.array(digits) & ~names).tolist():
            self._require_no_other_names(lines[k], int(at[k]))
        for place, column in cells.items():
            if self._is_clock(place):
                values[place] = column[kept]
            else:
                values[place], unreadable[place] = numbers(column[kept].tolist(), self._dialect.decimal)
        return Piece(at[kept], values, unreadable)

    def _require_no_other_names(self, line: str, number: int) -> None:
        """Refuses a second line of names with others than those above, as where two recordings stand in a file."""
        if self._dialect.names_others(line):
            raise RecordingError(
                f"{self.path}, line {number} names other columns than line {self._dialect.names_line}: "
                f"{plain(line, LONGEST_CELL)}; give each recording a file of its own"
            )

    def _all_numbers(self, lines: Sequence[str], places: Sequence[int], widest: int) -> dict[int, np.ndarray] | None:
        """The numbers, found all at once, NaN where there is none; None if something else is, or may be, among them, as
        true and false, which pandas takes for numbers."""
        text = "\n".join(lines).lower()
        if self._dialect.decimal == self._dialect.separator or any(truth in text for truth in TRUTHS):
            return None
        try:
            values = self._table(lines, places, widest, float)
        except ValueError:
            return None
        sound = all(len(column) == len(lines) and not np.isinf(column).any() for column in values.values())
        return values if sound else None

    def _cells(self, lines: Sequence[str], places: Sequence[int], widest: int) -> dict[int, np.ndarray]:
        """The cells of some columns. Quotes that enclose no cell are characters like others."""
        # `5" tyre` in a comment is no text in quotes
        for quoting in (csv.QUOTE_MINIMAL, csv.QUOTE_NONE):
            try:
                cells = self._table(lines, places, widest, str, quoting)
            except (ValueError, csv.Error) as error:
                problem = plain(error)
            else:
                if all(len(column) == len(lines) for column in cells.values()):
                    return cells
                problem = "a quote has no end"
        raise RecordingError(f"{self.path} is no CSV file: {problem}")

    def _table(
        self, lines: Sequence[str], places: Sequence[int], widest: int, kind: type[float | str], quoting: int = 0
    ) -> dict[int, np.ndarray]:
        """
        Raises:
            ValueError: a cell is none of that kind, or there is a quote without an end.
        """
        import pandas as pd  # takes most of a second

        separator = self._dialect.separator
        first = separator.join("0" * widest)  # says how many cells there can be
        # its numbers are those of Python to the last bit (pandas 3.1)
        table = pd.read_csv(
            StringIO("\n".join([first, *lines])),
            sep=separator,
            decimal=self._dialect.decimal if kind is float else ".",
            header=None,
            usecols=list(places),
            index_col=False,  # a separator at each end of line makes no index of the first column
            dtype=kind,
            na_filter=kind is float,
            na_values=SPELLINGS,  # else sparse files go cell by cell
            keep_default_na=False,
            skip_blank_lines=False,
            quoting=quoting,  # type: ignore[arg-type]
            engine="c",
        )
        return {place: table[place].to_numpy()[1:] for place in places}

    def _is_clock(self, place: int) -> bool:
        return place < len(self._dialect.clocks) and self._dialect.clocks[place]

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


def _is_cut_off(lines: Sequence[str], separator: str) -> bool:
    """Whether the last of some lines, which has no end, is shorter than those before it: by cells, or by decimals of
    its last number where all others have the same."""
    ends = [re.search(r"[.,][^.,]*$", line.rpartition(separator)[2]) for line in lines]
    # `4` is complete where others have no decimals either: a whole last row vanished
    *others, last = [(line.count(separator), len(end[0]) if end else 0) for line, end in zip(lines, ends, strict=True)]
    decimals = {count for _, count in others}
    return bool(others) and (last[0] < others[-1][0] or (len(decimals) == 1 and last[1] < min(decimals)))


class Piece(NamedTuple):
    """Some lines: their numbers in the file, the values of columns, of times of day the cells, and by column and index
    what cannot be read."""

    at: np.ndarray
    values: dict[int, np.ndarray]
    unreadable: dict[int, dict[int, str]]


def _columns(dialect: Dialect, beside: dict[str, str]) -> list[Column]:
    """The columns with their units: beside the name, in the line below it, or in the file beside results of ours."""
    columns = []
    for k, cell in enumerate(dialect.names):
        name, unit = split(cell)
        below = dialect.units[k].strip(" []()") if k < len(dialect.units) else ""
        if unit and below and not (converts(below, unit) and factor(below, unit) == 1.0):
            unit = f"{unit} and {below}"  # which is refused, if the column is needed
        own = "s" if k < len(dialect.clocks) and dialect.clocks[k] else unit or below or beside.get(name)
        columns.append(Column(plain(cell, LONGEST_CELL), plain(name, LONGEST_CELL), own))
    return columns


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
                decoder.decode(piece.replace(b"\xff", b""))  # which erased flash has behind a text
                piece = file.read(PIECE)
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
