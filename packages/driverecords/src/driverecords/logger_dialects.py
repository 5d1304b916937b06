"""Texts of loggers with a head of their own: LabVIEW (`.lvm`) and VBOX (`.vbo`)."""

from collections.abc import Sequence
from pathlib import Path

from .cells import decimal_of
from .dialect import Dialect
from .source import RecordingError

LABVIEW = "LabVIEW Measurement"

VBOX = {"time": "", "velocity": "km/h", "height": "m", "vert-vel": "m/s", "Tsample": "s"}
"""Units of the columns that every file has; `time` is a time of day."""


def logger_dialect(text: str, path: Path) -> Dialect | None:
    """That of such a file, None of any other.

    Args:
        text: its beginning.
        path: for messages.

    Raises:
        RecordingError: it has no times that are those of all columns.
    """
    lines = text.split("\n")
    if text.startswith(LABVIEW):
        return _labview(lines, path)
    if any(line.strip() == "[column names]" for line in lines[:LOOKED_AT]):
        return _vbox(lines, path)
    return None


LOOKED_AT = 500
"""Lines of a head."""


def _labview(lines: Sequence[str], path: Path) -> Dialect:
    separator = "," if lines[0].startswith(f"{LABVIEW},") else "\t"
    rows = [line.rstrip("\r").split(separator) for line in lines[:LOOKED_AT]]
    named = {row[0].strip(): row for row in rows if row[0].strip()}
    place = next((k for k, row in enumerate(rows) if row[0].strip() == "X_Value"), None)
    if place is None or named.get("X_Columns", ["", "One"])[1].strip() != "One" or rows[place].count("X_Value") > 1:
        raise RecordingError(
            f"{path} has no time that is that of all its channels; save it with `X Value Columns: One`"
        )
    # a German LabVIEW writes commas, and says so
    mark = named.get("Decimal_Separator", ["", "."])[1].strip()
    units = ["s", *(unit.strip() for unit in named.get("Y_Unit_Label", [""])[1:])]
    names = rows[place]
    return Dialect(separator, mark or ".", tuple(names), tuple(units[: len(names)]), (), place + 1, place + 2)


def _vbox(lines: Sequence[str], path: Path) -> Dialect:
    parts: dict[str, list[int]] = {}
    part: list[int] = []
    for k, line in enumerate(lines):
        if line.startswith("["):
            part = parts.setdefault(line.strip().strip("[]"), [])
            if line.startswith("[data]"):
                first = k + 1
                break
        elif line.strip():
            part.append(k)
    else:
        raise RecordingError(f"{path} has no [data]")
    if not parts["column names"]:
        raise RecordingError(f"{path} names no columns")
    line = parts["column names"][0]
    names = lines[line].split()
    # the channels of the user alone, which are the last ones
    own = [lines[k].strip() for k in parts.get("channel units", [])]
    units = [VBOX.get(name, "") for name in names[: len(names) - len(own)]] + own
    # 101557.00, a time of day that looks like a number
    clocks = tuple(name == "time" for name in names)
    decimal = decimal_of([cell for row in lines[first : first + LOOKED_AT] for cell in row.split()])
    return Dialect(" ", decimal, tuple(names), tuple(units[-len(names) :]), clocks, line + 1, first + 1)
