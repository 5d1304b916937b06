"""Whether a result that was made again is the same: what made it, and every number in it."""

import json
import shlex
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from toolground.digest import digest
from toolground.errors import UserError
from toolground.known_names import meant

from ..simulation.provenance import differences
from ..views.figure_options import KINDS

MADE_BY = ("program", "commit", "versions", "run", "inputs")
"""What of a record two results of the same numbers may differ in, beside the FMUs."""

DRAWN = (*(f".{kind}" for kind in KINDS), ".html")
"""Figures and pages show numbers of other files; they are not compared."""


CASE_COLUMNS = 4
"""Columns in the table of a campaign that tell a case from others."""

MORE = "more lines in one than in the other"


def read_record(path: Path) -> Mapping[str, Any]:
    """The record beside a result.

    Raises:
        UserError: it is none, or one from which nothing can be made again.
    """
    if not path.is_file():
        records = map(str, sorted((path if path.is_dir() else path.parent).glob("*.json")))
        near = f"did you mean {' or '.join(records)}?" if path.is_dir() else meant(str(path), records)
        what = f"{path} is a folder" if path.is_dir() else f"there is no file {path}"
        raise UserError("; ".join(filter(None, (what, near))))
    try:
        content = json.loads(path.read_text(encoding="utf-8") if path.stat().st_size else "")  # /proc/kmsg never ends
    except (ValueError, RecursionError) as error:
        raise UserError(f"{path} is no record of a result: it is not JSON") from error
    try:
        complete = isinstance(content["files"], dict) and {*MADE_BY, "command_line", "folder", "fmus"} <= content.keys()
        if complete:
            _origin(content)
            complete = isinstance(content["folder"], str) and bool(shlex.split(content["command_line"] or ""))
    except (ValueError, KeyError, TypeError, AttributeError):
        complete = False
    if not complete:
        raise UserError(f"{path} is no record of a result, or one of an earlier version, that names no digests")
    return content


def different_origin(before: Mapping[str, Any], now: Mapping[str, Any]) -> Iterator[str]:
    """In what two records differ: programs, versions, inputs, and FMUs by their content, wherever they stand."""
    yield from differences(_origin(before), _origin(now))


def _origin(record: Mapping[str, Any]) -> dict[str, Any]:
    fmus = {
        system: {name: fmu["digest"] for name, fmu in instances.items()} for system, instances in record["fmus"].items()
    }
    return {name: record[name] for name in MADE_BY} | {"FMU": fmus}


def different_files(
    before: Mapping[str, Any], there: Path, now: Mapping[str, Any], here: Path, apart: Sequence[Path] = ()
) -> Iterator[str]:
    """In which files two results have other numbers, and where first; and which files are gone, or were changed.

    Args:
        before, now: their records, which lie beside their files in the folders `there` and `here`.
        apart: files of the first one that lie elsewhere, if there are any.
    """
    for name, written in before["files"].items():
        path, made = _place(name, there, here, apart), _place(name, here, here)
        if path is None:
            yield f"{name} is gone"
            continue
        changed, other = digest(path) != written, now["files"].get(name) != written
        if name.endswith(DRAWN):
            if changed:
                yield f"{name} was changed after it was written"
        elif made is None:
            yield f"{name} is not made any more"
        elif changed and other:
            yield f"{name}: others than were written at first"
        elif changed:
            yield f"{name} was changed after it was written: {_first(path, made) or 'another content'}"
        elif other and (where := _first(path, made, _is_campaign(before))):
            yield f"{name}: {where}"
    yield from (f"{name} is new" for name in numeric(now) if name not in before["files"])


def further_cases(before: Mapping[str, Any], there: Path, here: Path) -> Iterator[str]:
    """Which files of a campaign have cases of which its command does not ask, and which are not compared."""
    for name in numeric(before) if _is_campaign(before) else ():
        path, made = _place(name, there, here), _place(name, here, here)
        if path and made and (more := len(_lines(path)) - len(_lines(made))) > 0:
            yield f"{name}: {more} cases beside those of its command are not compared"


def numeric(record: Mapping[str, Any]) -> list[str]:
    """The files that hold numbers."""
    return [name for name in record["files"] if not name.endswith(DRAWN)]


def _is_campaign(record: Mapping[str, Any]) -> bool:
    """Whether its files keep the cases of earlier commands, see `harness.simulation.case_archive`."""
    return "code" in record["run"]


def _place(name: str, there: Path, here: Path, apart: Sequence[Path] = ()) -> Path | None:
    """Where a file of a record lies: in the folder `there` as in `here`, where it was made again; else it is one of
    those that lie apart."""
    again = [path.relative_to(here) for path in here.rglob(Path(name).name) if path.as_posix().endswith(f"/{name}")]
    places = [*(there / path for path in [*again, name]), *(path for path in apart if path.name == Path(name).name)]
    return next((path for path in places if path.is_file()), None)


def _lines(path: Path) -> list[str]:
    return path.read_text(encoding="utf-8").splitlines() if path.suffix == ".csv" else []


def _first(there: Path, here: Path, campaign: bool = False) -> str | None:
    """Where two texts differ first; of a campaign, the cases that are in the second one. None: nowhere."""
    if there.suffix != ".csv":
        return "another content"
    with there.open(encoding="utf-8") as old, here.open(encoding="utf-8") as new:
        names: list[str] = []
        lines = ((number, was.rstrip("\n").split(",")) for number, was in enumerate(old, 1))
        for line in new:
            now = line.rstrip("\n").split(",")
            alike = (each for each in lines if not campaign or each[1][:CASE_COLUMNS] == now[:CASE_COLUMNS])
            number, was = next(alike, (0, None))
            if was is None:
                return f"the case {', '.join(now[:CASE_COLUMNS])} is not in it" if campaign else MORE
            names = names or was
            if was != now:
                k = next((k for k, (a, b) in enumerate(zip(was, now, strict=False)) if a != b), -1)
                return f"line {number}, {names[k]}: {was[k]} there, {now[k]} here"
        return None if campaign or next(lines, None) is None else MORE
