"""Recorded drives: CSV files whose columns carry their unit in brackets, as in `Velocity [km/h]`."""

import csv
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import DrivelineError
from ..names import nearest
from ..numbers import real
from ..plain import plain

GAP_LIMIT = 3.0
"""Longest step of time that is still no gap, in median steps."""

LONGEST_CELL = 60
"""Characters of a cell that are shown."""


@dataclass(frozen=True)
class RecordedColumn:
    """A quantity that a recording must contain: the names and units it may have in the file.

    Attributes:
        units: their factors to that of the SI.
        limit: largest magnitude that a drive can have, in the unit of the SI.
    """

    names: tuple[str, ...]
    units: dict[str, float]
    limit: float

    @property
    def example(self) -> str:
        return f"{self.names[0]} [{next(iter(self.units))}]"


COLUMNS = {
    "time": RecordedColumn(("Time", "t"), {"s": 1.0, "ms": 1e-3, "min": 60.0}, math.inf),
    "v": RecordedColumn(("Velocity", "Speed", "Vehicle Speed"), {"km/h": 1 / 3.6, "m/s": 1.0, "mph": 0.44704}, 200.0),
    "elevation": RecordedColumn(("Elevation", "Altitude", "Height"), {"m": 1.0, "km": 1e3, "ft": 0.3048}, 10_000.0),
    "T_mot": RecordedColumn(("Motor Torque", "Torque"), {"Nm": 1.0, "N.m": 1.0, "kNm": 1e3}, 10_000.0),
}


class RecordingError(DrivelineError):
    """A recording that cannot be used; the message says where and why."""


@dataclass(frozen=True, eq=False)
class Recording:
    """A recorded drive in SI units, one element a sample.

    Attributes:
        name: of the file, without its ending.
        time: in s, as recorded, strictly increasing.
        v: speed of the vehicle in m/s.
        elevation: of the road in m.
        T_mot: motor torque in N.m, motor side.
    """

    name: str
    time: np.ndarray
    v: np.ndarray
    elevation: np.ndarray
    T_mot: np.ndarray


def read_recording(path: Path) -> Recording:
    """Reads a recorded drive. Columns are found by name and converted by unit; others are ignored.

    Raises:
        RecordingError: there is no such file; a column is missing, doubled or of an unknown unit; a cell is not a
            finite number; time does not increase or has a gap (naming the line); it is no CSV file in UTF-8.
    """
    if not path.is_file():
        raise RecordingError(f"there is no recording {path}")
    try:
        return _read(path)
    except (UnicodeDecodeError, csv.Error) as error:
        raise RecordingError(f"{path} is no CSV file in UTF-8: {error}") from error


def _read(path: Path) -> Recording:
    with path.open(newline="", encoding="utf-8-sig") as file:
        rows = csv.reader(file)
        header = [plain(cell, LONGEST_CELL) for cell in next(rows, [])]
        places = {quantity: _find(path, header, column) for quantity, column in COLUMNS.items()}
        lines, table = [], []
        for row in rows:
            if any(cell.strip() for cell in row):
                lines.append(rows.line_num)
                table.append([_number(path, rows.line_num, header, row, place) for place, _ in places.values()])
    if len(table) < 2:
        raise RecordingError(f"{path}: {len(table)} samples; a drive needs at least two")
    factors = [factor for _, factor in places.values()]
    signals = dict(zip(places, (np.array(table) * factors).T, strict=True))
    _check_time(path, signals["time"], lines)
    for quantity, column in COLUMNS.items():
        _check_limit(path, column, signals[quantity], lines)
    return Recording(path.stem, **signals)


def _find(path: Path, header: list[str], column: RecordedColumn) -> tuple[int, float]:
    """Where a quantity stands in the rows, and the factor that turns it into SI units."""
    allowed = {name.casefold() for name in column.names}
    found = [(k, unit) for k, (name, unit) in enumerate(_named(header)) if name.casefold() in allowed]
    if not found:
        present = [name for name, _ in _named(header)]
        raise RecordingError(
            f"{path}, line 1: no column {column.example} (also {' or '.join(column.names[1:])}, "
            f"in {' or '.join(column.units)}); in the file: {nearest(column.names[0], present)}"
        )
    if len(found) > 1:
        cells = ", ".join(header[k].strip() for k, _ in found)
        raise RecordingError(f"{path}, line 1: {cells} all name {column.names[0]}; keep one of them")
    place, unit = found[0]
    if unit not in column.units:
        raise RecordingError(
            f"{path}, line 1: {header[place].strip()} has the unit {unit or '(none)'}; "
            f"allowed are {', '.join(column.units)}, written as in {column.example}"
        )
    return place, column.units[unit]


def _named(header: list[str]) -> Iterator[tuple[str, str]]:
    """Name and unit of each column."""
    for cell in header:
        name, _, unit = cell.partition("[")
        yield name.strip(), unit.strip().rstrip("]").strip()


def _number(path: Path, line: int, header: list[str], row: list[str], place: int) -> float:
    cell = row[place].strip() if place < len(row) else ""
    value = real(cell)
    if value is None or not math.isfinite(value):
        raise RecordingError(
            f"{path}, line {line}, column {header[place].strip()}: {plain(cell, LONGEST_CELL) or 'nothing'} "
            f"is not a finite number"
        )
    return value


def _check_time(path: Path, time: np.ndarray, lines: list[int]) -> None:
    steps = np.diff(time)
    backward = np.flatnonzero(steps <= 0.0)
    if len(backward):
        k = backward[0]
        raise RecordingError(f"{path}, line {lines[k + 1]}: time {time[k + 1]:g} s does not come after {time[k]:g} s")
    limit = GAP_LIMIT * float(np.median(steps))
    gaps = np.flatnonzero(steps > limit)
    if len(gaps):
        k = gaps[0]
        raise RecordingError(
            f"{path}, line {lines[k + 1]}: gap of {steps[k]:g} s after {time[k]:g} s; at most {limit:g} s "
            f"({GAP_LIMIT:g} times the median step) is allowed, so cut the file there"
        )


def _check_limit(path: Path, column: RecordedColumn, signal: np.ndarray, lines: list[int]) -> None:
    beyond = np.flatnonzero(np.abs(signal) > column.limit)
    if len(beyond):
        k, unit = beyond[0], next(unit for unit, factor in column.units.items() if factor == 1.0)
        raise RecordingError(
            f"{path}, line {lines[k]}: {column.names[0]} is {signal[k]:g} {unit}; "
            f"at most {column.limit:g} {unit} in magnitude can be"
        )
