"""Makes a result again from the record beside it, in a folder that vanishes, and compares every number to the last bit.

What differs is named: the version of a package, the commit, the digest of an input or of an FMU, and of each file the
first number that is another one. Every command that makes runs writes such a record.
Figures and pages are compared only with what was written at first. The exit code is 1 if a number is another one, or a
file is gone or was changed.

examples:
  driveline again results/compare/compare.json
  driveline again results/simulate/TwoMassDriveline_tipin15_DampingController.json
"""

import io
import shlex
from collections.abc import Callable, Mapping
from contextlib import chdir, redirect_stdout
from dataclasses import fields, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from toolground.arguments import filled, positional, record
from toolground.errors import UserError
from toolground.plain_text import plain
from toolground.printing import Printing

from .options import Replacing

PLACED = ("report", "output")
"""Options that may name a file of a result, which need not be beside its record."""


@record
class Arguments(Printing):
    made: Path = positional("the record of the result", Path, "RECORD.json")


def run(args: Arguments) -> int:
    from ..simulation.provenance import BEGINS_ANEW
    from .same_results import different_files, different_origin, further_cases, numeric, read_record

    before, there = read_record(args.made), args.made.absolute().parent
    command, given = _command(before, args.made.stem)
    apart = [Path(before["folder"]) / place for name in PLACED if (place := getattr(given, name, None))]
    with TemporaryDirectory(prefix="driveline-", ignore_cleanup_errors=True) as folder:
        try:
            code = _run(command, given, before["folder"], Path(folder), args.made.stem)
        except KeyboardInterrupt as stop:
            stop.__notes__ = [BEGINS_ANEW]  # a campaign says that it goes on, but its folder vanishes
            raise
        found = next(Path(folder).rglob(args.made.name), None)
        if found is None:
            records = sorted(path.name for path in Path(folder).glob("*.json"))
            made = f"but {' and '.join(records)}; was it renamed?" if records else f"and ended with exit code {code}"
            raise UserError(f"{args.made}: its command made no {args.made.name}, {made}")
        now = read_record(found)
        for difference in different_origin(before, now):
            print(f"made differently: {plain(difference)}")
        different = list(different_files(before, there, now, found.parent, apart))
        further = list(further_cases(before, there, found.parent))
    for difference in different:
        print(f"other numbers: {plain(difference)}" if ": " in difference else plain(difference))
    for line in further:
        args.say(plain(line))
    if not different:
        args.say(f"the same, to the last bit: {', '.join(numeric(before)) or 'no file has numbers'}")
    return int(bool(different))


def _command(before: Mapping[str, Any], name: str) -> tuple[Callable[[Any], int], Any]:
    """What the command of a record runs, and its arguments.

    Raises:
        UserError: it is no command of ours, or cannot be run where it ran.
    """
    from .cli import parser

    command_line, cwd = before["command_line"], Path(before["folder"])
    program, *words = shlex.split(command_line)
    if program != "driveline":
        raise UserError(f"it was made by another program, which can make it again: {plain(command_line)}")
    if not cwd.is_dir():
        raise UserError(f"it was made in the folder {cwd}, which is not there; its command: `{plain(command_line)}`")
    with chdir(cwd), redirect_stdout(io.StringIO()):
        try:
            parsed = parser().parse_args(words)
            given = filled(parsed.found.record, parsed)
        except SystemExit as stop:
            if stop.code:  # it has been said what is wrong
                raise
            given = None  # it asks for help
    if not isinstance(given, Replacing):  # others build, serve, or run what is no FMU
        raise UserError(f"the command of {name}.json makes no result of runs: {plain(command_line)}")
    return parsed.found.run, given


def _run(command: Callable[[Any], int], given: Any, cwd: str, folder: Path, name: str) -> int:
    """Runs a command where it ran, with its results in a folder, and the record of that name."""
    with chdir(cwd), redirect_stdout(io.StringIO()):
        return command(replace(given, **_elsewhere(given, folder, name)))


def _elsewhere(given: Any, folder: Path, name: str) -> dict[str, Any]:
    """What to change in the arguments of a command so that it writes into the folder and prints nothing.

    Args:
        name: of the record of the command.
    """
    defaults = {each.name: each.default for each in fields(given)}
    is_file = defaults["output"] is None  # beside which the record is
    file = given.output or getattr(given, "usual_output", Path(f"{name}.toml"))
    changes = {"output": folder / file.name if is_file else folder, "quiet": True}
    if getattr(given, "search", None):
        changes["search"] = folder
    if getattr(given, "report", None):
        changes["report"] = folder / "report.html"
    return changes | ({"json": False} if "json" in defaults else {})
