"""The options that several commands have, each with its check, and how they are read."""

import argparse
from math import isfinite
from pathlib import Path
from shlex import quote
from typing import Any

from ..cosimulation.system import BUILD, BUILD_HELP, BUILDS, NATIVE, PLANTS, chosen_build, loop
from ..errors import DrivelineError

LARGEST_SEED = 2**31 - 1
"""Of an FMI Integer."""

NAMED = f"{' or '.join(PLANTS)}, or an FMU with the same interface"
"""What --plant takes."""

PLANT_COMPLETION = {
    "bash": "_driveline_plants",
    "zsh": "_driveline_plants",
    "preamble": {
        "bash": f"""\
_driveline_plants() {{
  compgen -W "{" ".join(PLANTS)}" -- $1
  compgen -f -X "!*.fmu" -- $1
  compgen -d -- $1
}}""",
        "zsh": f"""\
_driveline_plants() {{
  _alternative "names:plant:({" ".join(PLANTS)})" "files:FMU:_files -g '*.fmu'"
}}""",
    },
}
"""For shtab: the names of the plants, or files."""


def add_plant(parser: argparse.ArgumentParser, **settings: Any) -> None:
    """--plant, with further settings of the argument."""
    action = parser.add_argument("--plant", metavar="NAME|FILE", **settings)
    action.complete = PLANT_COMPLETION  # type: ignore[attr-defined]


def add_loop(parser: argparse.ArgumentParser) -> None:
    """What every run of the loop can be given: parameters, seed and the FMUs."""
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        type=assignment,
        dest="parameters",
        metavar="INSTANCE.PARAMETER=VALUE",
        help="sets a parameter, in SI units (repeatable)",
    )
    parser.add_argument("--seed", type=seed, default=1, help="of the sensor noise (default: %(default)s)")
    parser.add_argument(
        "--build",
        choices=BUILDS,
        help=BUILD_HELP,
    )
    add_fmus(parser)


def add_fmus(parser: argparse.ArgumentParser) -> None:
    action = parser.add_argument(
        "--fmus",
        type=folder,
        default=BUILD,
        metavar="FOLDER",
        help="of the built FMUs, with the native ones in its folder native (default: %(default)s)",
    )
    action.complete = "directory"  # type: ignore[attr-defined]


def add_output(parser: argparse.ArgumentParser, default: str, files: str) -> None:
    """--output, the folder for everything that the command writes; `files` says what that is."""
    action = parser.add_argument(
        "--output",
        type=folder,
        default=Path(default),
        metavar="FOLDER",
        help=f"for {files} (default: %(default)s)",
    )
    action.complete = "directory"  # type: ignore[attr-defined]


def add_printing(parser: argparse.ArgumentParser, table: bool = False) -> None:
    """--quiet and, of a command that prints a table, --json."""
    parser.add_argument("--quiet", action="store_true", help="print only what goes wrong")
    if table:
        parser.add_argument("--json", action="store_true", help="print one JSON document in the place of the table")


def assignment(text: str) -> tuple[str, float]:
    """`instance.parameter` and value of `instance.parameter=value`; true and false are 1 and 0."""
    name, equals, value = (part.strip() for part in text.partition("="))
    instance, dot, parameter = name.partition(".")
    try:
        number = {"true": 1.0, "false": 0.0}.get(value.lower())
        number = float(value) if number is None else number
    except ValueError:
        number = None
    if not (instance and dot and parameter and equals) or number is None:
        raise argparse.ArgumentTypeError(f"{text!r} is not of the form plant.J_1=0.06")
    if not isfinite(number):
        raise argparse.ArgumentTypeError(f"{text!r}: a parameter is a finite number")
    return name, number


def seed(text: str) -> int:
    """A whole number that an FMI Integer holds."""
    try:
        number = int(text)
    except ValueError:
        number = -1
    if not 0 <= number <= LARGEST_SEED:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number from 0 to {LARGEST_SEED}")
    return number


def seconds(text: str) -> float:
    """A time above 0 s."""
    try:
        number = float(text)
    except ValueError:
        number = 0.0
    if not (isfinite(number) and number > 0.0):
        raise argparse.ArgumentTypeError(f"{text!r} is not a time above 0 s")
    return number


def folder(text: str) -> Path:
    """The path of a folder, which may not exist yet."""
    if not text:
        raise argparse.ArgumentTypeError("the name of the folder is empty")
    path = Path(text)
    if path.exists() and not path.is_dir():
        raise argparse.ArgumentTypeError(f"{text} is a file; a folder is needed")
    return path


def built(plant: str, folder: Path, build: str | None = None) -> str:
    """The build that runs with that plant, which is the one asked for if there is one.

    Raises:
        WiringError: there is no such plant.
        DrivelineError: FMUs of the project are missing; says which command makes them.
    """
    build = build or chosen_build(plant, folder)
    missing = [path for path in loop(plant, folder, build).instances.values() if not path.is_file()]
    if missing and missing[0].is_relative_to(folder):
        where = "" if folder == BUILD else f" --output {quote(str(folder))}"
        only = f" --build {NATIVE}" if build == NATIVE else ""
        raise DrivelineError(f"there is no FMU {missing[0]}; `driveline build{only}{where}` makes it")
    return build
