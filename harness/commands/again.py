"""Makes a result again from the record beside it, in a folder that vanishes, and compares every number to the last bit.

What differs is named: the version of a package, the commit, the digest of an input or of an FMU, and of each file the
first number that is another one. Every command that makes runs writes such a record.
Figures and pages are not compared. The exit code is 1 if a number is another one.

examples:
  driveline again results/compare/compare.json
  driveline again results/simulate/TwoMassDriveline_tipin15_DampingController.json
"""

import io
import shlex
from collections.abc import Mapping
from contextlib import chdir, redirect_stdout
from dataclasses import fields, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from ..base.command_line import PROGRAM
from ..base.errors import DrivelineError
from ..base.plain_text import plain
from .arguments import filled, positional, record
from .options import Replacing
from .printing import Printing


@record
class Arguments(Printing):
    made: Path = positional("the record of the result", Path, "RECORD.json")


def run(args: Arguments) -> int:
    from ..simulation.provenance import BEGINS_ANEW
    from .same_results import different_numbers, different_origin, numeric, read_record

    before, there = read_record(args.made), args.made.absolute()
    with TemporaryDirectory(prefix="driveline-", ignore_cleanup_errors=True) as folder:
        try:
            code = _run(before, Path(folder), args.made.stem)
        except KeyboardInterrupt as stop:
            stop.__notes__ = [BEGINS_ANEW]  # a campaign says that it goes on, but its folder vanishes
            raise
        found = next(Path(folder).rglob(args.made.name), None)
        if found is None:
            records = sorted(path.name for path in Path(folder).glob("*.json"))
            made = f"but {' and '.join(records)}; was it renamed?" if records else f"and ended with exit code {code}"
            raise DrivelineError(f"{args.made}: its command made no {args.made.name}, {made}")
        now = read_record(found)
        for difference in different_origin(before, now):
            print(f"made differently: {plain(difference)}")
        numbers = list(different_numbers(before, there.parent, now, found.parent))
    for difference in numbers:
        print(f"other numbers: {plain(difference)}")
    if not numbers:
        args.say(f"the same, to the last bit: {', '.join(numeric(before)) or 'no file has numbers'}")
    return int(bool(numbers))


def _run(before: Mapping[str, Any], folder: Path, name: str) -> int:
    """Runs the command of a record where it ran, with its results in a folder, and the record of that name.

    Raises:
        DrivelineError: it is no command of ours, or cannot be run there.
    """
    from .cli import parser

    command_line, cwd = before["command_line"], Path(before["folder"])
    program, *words = shlex.split(command_line)
    if program != PROGRAM:
        raise DrivelineError(f"it was made by another program, which can make it again: {plain(command_line)}")
    if not cwd.is_dir():
        raise DrivelineError(
            f"it was made in the folder {cwd}, which is not there; its command: `{plain(command_line)}`"
        )
    with chdir(cwd), redirect_stdout(io.StringIO()):
        try:
            parsed = parser().parse_args(words)
            given = filled(parsed.found.record, parsed)
        except SystemExit as stop:
            if stop.code:  # it has been said what is wrong
                raise
            given = None  # it asks for help
        if not isinstance(given, Replacing):  # others build, serve, or run what is no FMU
            raise DrivelineError(f"the command of {name}.json makes no result of runs: {plain(command_line)}")
        return parsed.found.run(replace(given, **_elsewhere(given, folder, name)))


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
