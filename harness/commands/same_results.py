"""Whether a result that was made again is the same: what made it, and every number in it."""

import json
import shlex
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from ..base.digest import digest
from ..base.errors import DrivelineError
from ..simulation.provenance import differences
from ..views.figure_options import KINDS

MADE_BY = ("program", "commit", "versions", "run", "inputs")
"""What of a record two results of the same numbers may differ in, beside the FMUs."""

DRAWN = (*(f".{kind}" for kind in KINDS), ".html")
"""Figures and pages show numbers of other files; they are not compared."""


def read_record(path: Path) -> Mapping[str, Any]:
    """The record beside a result.

    Raises:
        DrivelineError: it is none, or one from which nothing can be made again.
    """
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        complete = isinstance(content["files"], dict) and {*MADE_BY, "command_line", "folder", "fmus"} <= content.keys()
        if complete:
            _origin(content)
            complete = isinstance(content["folder"], str) and bool(shlex.split(content["command_line"] or ""))
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise DrivelineError(f"{path} is no record of a result: {type(error).__name__}") from error
    if not complete:
        raise DrivelineError(f"{path} is no record of a result, or one of an earlier version, that names no digests")
    return content


def different_origin(before: Mapping[str, Any], now: Mapping[str, Any]) -> Iterator[str]:
    """In what two records differ: programs, versions, inputs, and FMUs by their content, wherever they stand."""
    yield from differences(_origin(before), _origin(now))


def _origin(record: Mapping[str, Any]) -> dict[str, Any]:
    fmus = {
        system: {name: fmu["digest"] for name, fmu in instances.items()} for system, instances in record["fmus"].items()
    }
    return {name: record[name] for name in MADE_BY} | {"FMU": fmus}


def different_numbers(before: Mapping[str, Any], there: Path, now: Mapping[str, Any], here: Path) -> Iterator[str]:
    """In which files two results have other numbers, and where first.

    Args:
        before, now: their records, which lie beside their files in the folders `there` and `here`.
    """
    for name in numeric(before):
        if name not in now["files"]:
            yield f"{name} is not made any more"
        elif before["files"][name] != now["files"][name]:
            same = (there / name).is_file() and digest(there / name) == before["files"][name]
            yield f"{name}: {_first(there / name, here / name) if same else 'others than were written at first'}"
        elif (there / name).is_file() and digest(there / name) != before["files"][name]:
            yield f"{name} was changed after it was written: {_first(there / name, here / name)}"
    yield from (f"{name} is new" for name in numeric(now) if name not in before["files"])


def numeric(record: Mapping[str, Any]) -> list[str]:
    """The files that hold numbers."""
    return [name for name in record["files"] if not name.endswith(DRAWN)]


def _first(there: Path, here: Path) -> str:
    """Where two texts differ first."""
    if there.suffix != ".csv":
        return "another content"
    with there.open(encoding="utf-8") as old, here.open(encoding="utf-8") as new:
        names: list[str] = []
        for number, (was, now) in enumerate(zip(old, new, strict=False), 1):
            cells, others = was.rstrip("\n").split(","), now.rstrip("\n").split(",")
            names = names or cells
            if cells != others:
                k = next((k for k, (a, b) in enumerate(zip(cells, others, strict=False)) if a != b), -1)
                return f"line {number}, {names[k]}: {cells[k]} there, {others[k]} here"
    return "more lines in one than in the other"
