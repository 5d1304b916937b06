"""Logs of a bus as python-can reads them, and what it does not know of some of them."""

import re
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from datetime import UTC
from io import TextIOBase
from itertools import chain, islice, pairwise
from pathlib import Path
from typing import Any, NamedTuple

from toolground.optional_packages import required
from toolground.plain_text import plain

from .cells import is_number
from .clock_times import DAY, EPOCH, Clock, read_clock
from .source import RecordingError


class Kind(NamedTuple):
    """A kind of log.

    Attributes:
        name: of the kind.
        begin: with which such files begin, after empty lines.
        reader: its class in python-can.
        lines: turns its lines into those that python-can reads; None if they are, or if it is no text.
    """

    name: str
    begin: re.Pattern[bytes]
    reader: str
    lines: Callable[[Iterable[str]], Iterator[str]] | None = None


# a log of a system with decimal commas has them in its times
STAMP = re.compile(r"\s*(\d+(?:[.,]\d*)?|[.,]\d+)\s+(.*)", re.DOTALL)
# `date Mon Jan 5 10:15:30.500 am 2026` above all, and again behind `Begin TriggerBlock`
DATE = re.compile(r"\s*(?:date|begin\s+triggerblock)\s+\w+\s+(.+)", re.IGNORECASE)
NAMED = re.compile(r"(\d+\s+)\w+(\s+[TR]x\s.*\bID = (\d+)(x?)\s*)", re.IGNORECASE | re.DOTALL)
"""A frame whose number stands behind too: before it may be its name, such as DCDC."""

# python-can splits a CAN FD frame into five cells and its data: one of no bytes ends a cell too early
EMPTY_FD = re.compile(r"(CANFD\s+\d+\s+[TR]x\s+\S+(?:\s+\S+)?\s+[01]\s+[01]\s+0\s+0)\s*", re.IGNORECASE)


def asc_lines(lines: Iterable[str]) -> Iterator[str]:
    """Lines of an ASC log with times from its begin on. Relative ones are each from the line before; those of a second
    measurement in the file begin again, and go on by the dates of both. Requests to send are left out."""
    relative, at, begin, shift, block, number = False, 0.0, None, 0.0, 0.0, "X"
    for line in lines:
        if line.lower().lstrip().startswith("base"):
            relative, number = "relative" in line.lower(), "d" if "dec" in line.lower() else "X"
            line += "\nno internal events logged\n"  # python-can takes the line behind the head for a part of it
        elif match := DATE.match(line):
            # a logger that is triggered again goes on with a second block, whose times begin at 0
            date = _seconds(match[1])
            begin = date if begin is None else begin
            block = 0.0 if date is None or begin is None else date - begin
            at = max(at, block) if relative else at
        elif match := STAMP.fullmatch(line):
            time = float(match[1].replace(",", "."))
            last, at = at, at + time if relative else time + shift
            # a late frame goes back too, but not to before the date of its block
            if at < last < block:
                shift = block
                at = time + shift
            rest, named = EMPTY_FD.fullmatch(match[2]), NAMED.fullmatch(match[2])
            # `ID = 256` is decimal, whatever the base of the log is
            frame = f"{named[1]}{int(named[3]):{number}}{named[4]}{named[2]}" if named else match[2]
            line = f"{at:.9f} {f'{rest[1]} 00' if rest else frame}"
            if " TxRq " in line:
                continue
        yield from line.splitlines(keepends=True)


def _seconds(text: str) -> float | None:
    """Of a date with a time of day, since 1970."""
    from dateutil.parser import ParserError, parse

    try:
        return parse(text).replace(tzinfo=UTC).timestamp()
    except (ParserError, OverflowError, ValueError):
        return None


# as `candump -x -a` prints: (000.010000)  can0  RX - -  100   [4]  01 00 00 00   '....'
CONSOLE = re.compile(
    r"\s*\(([^)]+)\)\s+(\S+)\s+(?:[TR]X\s+(?:\S\s+){1,2})?([0-9A-F]+)\s+\[(\d+)\]\s*(.*)", re.IGNORECASE | re.DOTALL
)


FIRST_LINES = 1000
"""Lines by which it is decided what times of candump are."""


def candump_lines(lines: Iterable[str]) -> Iterator[str]:
    """Lines as `candump -l` writes them, of those and of what it prints. Times are each from the line before (-t d) if
    of those of the FIRST_LINES more than a tenth go back, or if they begin with 0 and do not change."""
    begin = [*islice(lines := iter(lines), FIRST_LINES)]
    stamps = [match[1] for match in map(CONSOLE.fullmatch, begin) if match and is_number(match[1])]
    steps = [float(b) - float(a) for a, b in pairwise(stamps)]
    # -t d of a cyclic message: 0, and the same from then on; -t z of a coarse clock begins with 0 too, and goes on
    steady = len(steps) > 1 and not any(steps[1:]) and float(stamps[0]) == 0.0
    relative, at = steady or 10 * sum(step < 0.0 for step in steps) > len(stamps), 0.0
    for line in chain(begin, lines):
        if line.startswith("#"):
            continue
        if match := CONSOLE.fullmatch(line):
            # -a prints the bytes once more as letters
            data = match[5].partition("'")[0]
            data = "R" if data.startswith("remote") else data.replace(" ", "").strip()
            # [08] with two digits is a frame of CAN FD
            mark = "##0" if len(match[4]) > 1 else "#"
            clock = read_clock(match[1])  # -t A prints the date
            time = clock.second + DAY * ((clock.day or EPOCH) - EPOCH) if clock else at * relative + float(match[1])
            at = time
            yield f"({time:.6f}) {match[2]} {match[3]}{mark}{data}\n"
        else:
            yield line


BLF = re.compile(rb"LOGG")
ASC = re.compile(rb"(\xef\xbb\xbf)?\s*(//[^\n]*\n\s*)*(date [^\n]*\n\s*)?base\s+(hex|dec)", re.IGNORECASE)
# a table whose first column is a date in brackets is no log: an identifier has to follow
CANDUMP = re.compile(rb"\s*(#[^\n]*\n\s*)*\([-: \d]+\.\d+\)\s+\S+\s+(\S+\s+){0,3}[0-9A-Fa-f]+(#|\s+\[)")

LOGS = (
    Kind("BLF", BLF, "BLFReader"),
    Kind("ASC", ASC, "ASCReader", asc_lines),
    Kind("candump", CANDUMP, "CanutilsLogReader", candump_lines),
    Kind("CSV of python-can", re.compile(rb"timestamp,arbitration_id,"), "CSVReader"),
    # version 1.0 of PCAN-View begins with a line of marks, later ones with their number
    Kind("TRC", re.compile(rb"\s*;(\$FILEVERSION|#{20}|-{20})"), "TRCReader"),
)


def kind_of(begin: bytes) -> Kind | None:
    """The kind of log that begins so."""
    return next((kind for kind in LOGS if kind.begin.match(begin)), None)


def began(path: Path, first: float) -> Clock | None:
    """What the clock said at the first frame, if the log tells.

    Args:
        first: time of that frame in s.
    """
    second = first
    if first < DATED:
        with path.open("rb") as file:
            dates = filter(None, map(DATE.match, file.read(LOOKED_AT).decode("latin-1").splitlines()))
            start = next((_seconds(date[1]) for date in dates), None)
        if start is None:
            return None
        second += start
    return Clock(EPOCH + int(second // DAY), second % DAY)


DATED = 1e8
"""Seconds since 1970 from which on a time is one of a clock, and not since the beginning."""


class Lines(TextIOBase):
    """A text whose lines are made as they are read.

    Attributes:
        cut_off: whether the last that was read has no end.
    """

    def __init__(self, lines: Iterator[str]) -> None:
        super().__init__()
        self._lines = lines
        self.cut_off = False

    def __next__(self) -> str:
        line = next(self._lines)
        self.cut_off = not line.endswith("\n")
        return line

    def read_by(self, reader: Iterable[Any]) -> Iterator[Any]:
        """What a reader finds in them, up to a last line that was cut off."""
        try:
            yield from reader
        except ValueError:
            if not self.cut_off:
                raise


@contextmanager
def messages(path: Path) -> Iterator[Iterable[Any]]:
    """The messages of a log, while it is read; whatever python-can meets in a damaged one is a RecordingError."""
    can = required("can", "reading logs of a bus", "driverecords[formats]")
    with path.open("rb") as file:
        kind = kind_of(file.read(LOOKED_AT))
    assert kind is not None, "only logs are read so"
    reader = getattr(can, kind.reader, None) or getattr(can.io, kind.reader)
    try:
        if kind.lines is None:
            with reader(path) as log:
                yield log
        else:
            # logs begin with a byte-order mark, and end within a character where they were cut off
            with path.open(encoding="utf-8-sig", errors="replace") as text:
                lines = Lines(kind.lines(text))
                yield lines.read_by(reader(lines))
    except (RecordingError, MemoryError):
        raise
    except Exception as error:
        detail = plain(error, 200) or type(error).__name__
        raise RecordingError(f"{path} is a damaged log of a bus: {detail}") from error


LOOKED_AT = 1000
"""Bytes at the beginning that tell which kind it is."""
