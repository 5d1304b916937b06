"""What made a result: a JSON file beside it, and by it two runs that are not the same are told apart."""

import json
import platform
import subprocess
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from importlib.metadata import version
from pathlib import Path
from types import MappingProxyType
from typing import Any

from fmuloop import row_layout
from fmuloop.wiring import Fit
from toolground.atomic_files import alone, as_before_if_stopped, remove, replaceable, write_text
from toolground.child_process import output_of
from toolground.command_line import command_line
from toolground.digest import digest
from toolground.errors import UserError

ROOT = Path(__file__).resolve().parents[2]

BEGINS_ANEW = "nothing of it is left, and the same command begins anew"
"""What is said of a run that was stopped."""


class Made:
    """What a run writes, see `recorded`.

    Attributes:
        files: that it has written.
        begun: whether files are being replaced.
        found: what the record tells of the runs beside.
    """

    def __init__(self, record: Path, require: Callable[[], None], kept: ExitStack) -> None:
        """Args:
        require: refuses if there are results of another run.
        kept: what lasts until the record is written.
        """
        self.files: list[Path] = []
        self.found: dict[str, Any] = {}
        self._record = record
        self._require = require
        self._kept = kept
        self.begun = False
        self._new_folders: set[Path] = set()

    def begin(self, *others: Path) -> None:
        """From now on files are replaced. Their records go first: one that is killed leaves none that is not theirs.

        Other runs into the folder wait until the record is written.

        Args:
            others: files that other processes will write, and records of parts of the results.

        Raises:
            UserError: another run has written its results in the meantime.
        """
        if not self.begun:
            places = {folder for path in (self._record, *others) for folder in path.absolute().parents}
            self._new_folders = {folder for folder in places if not folder.exists()}
            self._kept.enter_context(alone(self._record.parent))
            self._require()
            self.begun = True
        for path in (self._record, *others):
            remove(path)

    def remove_empty_folders(self) -> None:
        """Of those that were not there before: a run that came to nothing leaves none."""
        for folder in sorted(self._new_folders, reverse=True):
            with suppress(OSError):  # it was never made, or there is something in it
                folder.rmdir()


@contextmanager
def recorded(
    record: Path,
    run: Mapping[str, Any],
    fits: Mapping[str, Fit],
    inputs: Sequence[Path | None],
    results: Sequence[Path] = (),
    replace: bool = False,
) -> Iterator[Made]:
    """Within it a run is made and written; at its end the record tells what made the files. When it is
    stopped, the files are as they were before.

    Args:
        record: the JSON file beside the results.
        run: all that distinguishes it.
        fits: the systems that run, by their names.
        inputs: files beside the FMUs that it reads.
        results: files that it will write, as far as their names are known.
        replace: whether results of another run may be replaced.

    Raises:
        UserError: there are results of another run, or a folder in the place of one; nothing has been run.
    """

    def require() -> None:
        require_files([*results, record])
        if not replace:
            require_same_run(record, run, results)

    require()
    with ExitStack() as kept:
        made = Made(record, require, kept)
        try:
            with as_before_if_stopped():
                yield made
                write_record(record, run, fits, made.files, inputs, made.found)
        except BaseException as stop:
            made.remove_empty_folders()
            if isinstance(stop, KeyboardInterrupt):
                stop.add_note(BEGINS_ANEW)
            raise


def require_files(paths: Sequence[Path]) -> None:
    """Refuses a folder in the place of a file that will be written.

    Raises:
        UserError: there is one.
    """
    if folder := next((path for path in paths if path.is_dir()), None):
        raise UserError(f"{folder} is a folder; a file is needed")


def require_same_run(record: Path, run: Mapping[str, Any], results: Sequence[Path]) -> None:
    """Refuses to replace results of another run.

    Args:
        record: the JSON file that tells what made the results that are there.
        run: all that distinguishes the run that is to be made.
        results: files that it will write, as far as their names are known.

    Raises:
        UserError: there are results of another run, or of one that nothing tells of.
    """
    there = next((path for path in results if path.is_file()), record if record.is_file() else None)
    if there is None:
        return
    try:
        before = json.loads(record.read_text(encoding="utf-8") if record.is_file() else "")["run"]
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        reason = f"is there, and {record} does not tell of which run it is"
    else:
        changed = next(differences(before, json.loads(_text(run))), None)
        if changed is None:
            return
        reason = f"is of another run ({changed})"
    raise UserError(f"{there} {reason}; give another folder as --output, or --replace to overwrite it")


def require_same_text(text: str, path: Path) -> None:
    """Refuses to replace a file that has another text.

    Raises:
        UserError: the file at `path` has.
    """
    if replaceable(path) and path.read_bytes() != text.encode():
        raise UserError(
            f"{path} is there with another content; give another place as --output, or --replace to overwrite it"
        )


FOLLOWING = ("frequency", "road_load", "start_values")
"""Keys that mainly follow from the others: named last."""


def differences(before: Any, now: Any, name: str = "") -> Iterator[str]:
    """In what two runs differ, in words."""
    if isinstance(before, dict) and isinstance(now, dict):
        for key in sorted(before.keys() | now.keys(), key=lambda key: (key in FOLLOWING, key)):
            yield from differences(before.get(key), now.get(key), f"{name} {key}".strip())
    elif before in ({}, None) and now in ({}, None):
        return  # nothing is set in either
    elif isinstance(before, dict) and now is None:
        yield f"{name} is in that run, not in this one"
    elif before is None and isinstance(now, dict):
        yield f"{name} is in this run, not in that one"
    elif before != now:
        yield f"{name}: {'not set' if before is None else before} there, {'not set' if now is None else now} here"


def write_record(
    record: Path,
    run: Mapping[str, Any],
    fits: Mapping[str, Fit],
    files: Sequence[Path],
    inputs: Sequence[Path | None],
    found: Mapping[str, Any] = MappingProxyType({}),
) -> None:
    """Writes what made the files of a run; the arguments are those of `content`."""
    write_text(_text(content(run, fits, files, inputs, found, record.parent)), record)


def content(
    run: Mapping[str, Any],
    fits: Mapping[str, Fit],
    files: Sequence[Path],
    inputs: Sequence[Path | None],
    found: Mapping[str, Any] = MappingProxyType({}),
    folder: Path = Path(),
) -> dict[str, Any]:
    """What made the files of a run.

    Args:
        run: all that distinguishes it.
        fits: the systems that ran, by their names.
        files: that it has written.
        inputs: files beside the FMUs that it has read.
        found: what else is to be told of it.
        folder: in which the record stands.
    """
    return {
        "program": f"driveline-damping {version('driveline-damping')}",
        "commit": commit(),
        "command_line": command_line(),
        "folder": str(Path.cwd()),
        "versions": versions(),
        "run": run,
        **found,
        "fmus": {
            system: {name: {"file": path, "digest": digest(path)} for name, path in fit.system.instances.items()}
            for system, fit in fits.items()
        },
        "inputs": {str(path): digest(path) for path in inputs if path is not None},
        "files": {_name(path, files, folder): digest(path) if path.is_file() else None for path in files},
        "units": {name: unit for fit in fits.values() for name, unit in _units(fit).items()},
    }


def _name(path: Path, files: Sequence[Path], folder: Path) -> str:
    """Of a file in a record in a folder: with its way from there where another one has the same."""
    if sum(other.name == path.name for other in files) == 1:
        return path.name
    path, folder = path.absolute(), folder.absolute()
    return path.relative_to(folder).as_posix() if path.is_relative_to(folder) else str(path)


def _units(fit: Fit) -> dict[str, str]:
    return row_layout.units(fit.interfaces, [port.name for port in fit.system.inputs])


def versions() -> dict[str, str]:
    """Of what the last digits of a number may depend on."""
    packages = {name: version(name) for name in ("numpy", "scipy", "fmpy")}
    return {"python": platform.python_version(), "machine": f"{platform.system()} {platform.machine()}", **packages}


def commit() -> str | None:
    """The commit of the checkout, with -dirty if files have changed since; None if there is none."""
    if not (ROOT / ".git").exists():
        return None
    command = ["git", "-C", str(ROOT), "describe", "--always", "--dirty", "--abbrev=40", "--exclude=*"]
    try:
        return output_of(*command)
    except (OSError, subprocess.CalledProcessError):
        return None


def _text(content: Any) -> str:
    return json.dumps(content, indent=2, default=str) + "\n"
