"""The options that several commands have, each with its check; `harness.commands.settings` says what they mean."""

import argparse
from collections.abc import Mapping, Sequence
from math import ceil, isfinite
from pathlib import Path
from typing import Any

from ...fmus.building.options import add_parameter_files, folder, output_folder
from ..base.errors import DrivelineError
from ..base.plain_text import quoted
from ..base.written_numbers import real, whole
from ..cosimulation.limits import USUAL_LIMITS
from ..loop.places import BUILD, BUILD_HELP, BUILDS, PLACES, PLANTS
from ..views.figure_options import KINDS, USUAL_KINDS, FigureOptions
from ..views.signals_file import FORMATS

OTHERS = {"controller": "damping control", "motor": "motor with its torque loop", "can": "wheel speeds over the bus"}
"""The blocks of the loop beside the plant, and what they are."""

EXPERTS = "options for experts"
"""The last group of a help."""

LEAST_WINDOW = 0.01
"""In s, of the figures: a few samples."""


def experts(parser: argparse.ArgumentParser) -> argparse._ArgumentGroup:
    """The group of the options that few need."""
    there = (group for group in parser._action_groups if group.title == EXPERTS)
    return next(there, None) or parser.add_argument_group(EXPERTS)


class Assigned(argparse._AppendAction):
    """Appends a parameter with its value, of which there is one."""

    def __call__(self, parser, namespace, values, option_string=None) -> None:
        name, value = values  # type: ignore[misc]
        if (before := dict(getattr(namespace, self.dest)).get(name, value)) != value:
            raise argparse.ArgumentError(self, f"{name} is given twice, {before!r} and {value!r}; it takes one value")
        super().__call__(parser, namespace, values, option_string)


def add_plant(
    parser: argparse.ArgumentParser, several: bool = False, default: str = PLANTS[0], because: str = ""
) -> None:
    """--plant; `several` can be given, by default both, or one with a default, if it is not the usual one because of
    something."""
    block = f"the car: {' or '.join(PLANTS)}, or an FMU with the same interface"
    usual = "repeatable; default: both" if several else f"default: %(default)s{because and f', {because}'}"
    action = parser.add_argument(
        "--plant",
        metavar="NAME|FILE",
        action="append" if several else "store",
        default=None if several else default,
        help=f"{block} ({usual})",
    )
    action.complete = _names_or_fmus(PLANTS)  # type: ignore[attr-defined]


def add_controller(parser: argparse.ArgumentParser) -> None:
    """--controller, of the project, and the files with the values of car and controller."""
    names = PLACES["controller"]
    parser.add_argument(
        "--controller",
        choices=names,
        metavar="NAME",
        default=names[0],
        help=f"damping control: {', '.join(names)} (default: %(default)s)",
    )
    add_parameter_files(parser)


def names_or_files(names: Sequence[str], endings: Sequence[str], what: str) -> dict[str, Any]:
    """What shtab is told to complete one of the names or the path of a file."""
    function = f"_driveline_{names[0]}"
    patterns = " ".join(f"*.{ending}" for ending in endings)
    files = "\n".join(f'  compgen -f -X "!*.{ending}" -- $1' for ending in endings)
    return {
        "bash": function,
        "zsh": function,
        "tcsh": f"({' '.join(names)})",
        "preamble": {
            "bash": f"""\
{function}() {{
  compgen -W "{" ".join(names)}" -- $1
{files}
  compgen -d -- $1
}}""",
            "zsh": f"""\
{function}() {{
  _alternative "names:{what}:({" ".join(names)})" "files:file:_files -g '{patterns}'"
}}""",
        },
    }


def _names_or_fmus(names: Sequence[str]) -> dict[str, Any]:
    return names_or_files(names, ("fmu",), "block")


def add_loop(
    parser: argparse.ArgumentParser, several: Mapping[str, str] | None = None, drawn: str = "the sensor noise"
) -> None:
    """What every run of the loop can be given beside the plant; `harness.commands.settings` reads it.

    Args:
        several: the places for which several blocks can be given, and what stands there if none is, in words.
        drawn: what the seed is of.
    """
    several = several or {}
    parser.add_argument(
        "--set",
        action=Assigned,
        default=[],
        type=assignment,
        dest="assignments",
        metavar="INSTANCE.PARAMETER[@TIME]=VALUE",
        help="sets a parameter, in SI units, whatever the files say; with @TIME a tunable one, from that time in s on "
        "(repeatable)",
    )
    add_parameter_files(parser)
    for place, meaning in OTHERS.items():
        names = PLACES[place]
        action = (parser if place == "controller" else experts(parser)).add_argument(
            f"--{place}",
            metavar="NAME|FILE",
            action="append" if place in several else "store",
            default=None if place in several else names[0],
            help=f"{meaning}: {', '.join(names)} or an FMU "
            f"({'repeatable; ' if place in several else ''}default: {several.get(place, names[0])})",
        )
        action.complete = _names_or_fmus(names)  # type: ignore[attr-defined]
    experts(parser).add_argument(
        "--map",
        action="append",
        default=[],
        metavar="INSTANCE.NAME=THEIRS",
        help="what an FMU calls a variable of the loop, as in plant.T_gear=Shaft.tau; units are converted (repeatable)",
    )
    parser.add_argument("--seed", type=seed, default=1, help=f"of {drawn} (default: %(default)s)")
    experts(parser).add_argument("--build", choices=BUILDS, help=BUILD_HELP)
    add_fmus(parser)
    add_limits(parser)


def add_cases(parser: argparse.ArgumentParser, default: int, most: int, one: str) -> None:
    """--cases, --case and --scheduler; `one` says what a single case is."""

    def number(text: str) -> int:
        return count(text, 1, most)

    parser.add_argument(
        "--cases", type=number, default=default, metavar="COUNT", help="how many (default: %(default)s)"
    )
    parser.add_argument("--case", type=number, metavar="NUMBER", help=one)
    experts(parser).add_argument("--scheduler", metavar="ADDRESS", help="of a Dask cluster that runs the cases")


def add_fmus(parser: argparse.ArgumentParser) -> None:
    experts(parser).add_argument(
        "--fmus",
        type=folder,
        default=BUILD,
        metavar="FOLDER",
        help="of the built FMUs, with the native ones in its folder native (default: %(default)s)",
    )


def add_limits(parser: argparse.ArgumentParser) -> None:
    """What FMUs that are not ours may take."""
    group = experts(parser)
    group.add_argument(
        "--time-limit",
        type=seconds,
        default=USUAL_LIMITS.call,
        metavar="SECONDS",
        help="how long a call of an FMU that is given by its path may last (default: %(default)g)",
    )
    group.add_argument(
        "--unpacked-limit",
        type=megabytes,
        default=USUAL_LIMITS.unpacked,
        metavar="MB",
        help=f"how much it may unpack to (default: {USUAL_LIMITS.unpacked / 1e6:.0f})",
    )


def add_output(parser: argparse.ArgumentParser, default: str, files: str, of_a_run: bool = False) -> None:
    """--output, the folder for everything that the command writes; `files` says what that is.

    Where they are the results of a run that options distinguish, --replace too.
    """
    parser.add_argument(
        "--output",
        type=_output,
        default=default,
        metavar="FOLDER",
        help=f"for {files} (default: %(default)s)",
    )
    if of_a_run:
        add_replace(parser)


def _output(text: str) -> Path:
    """A folder; the name of a file of signals is a slip."""
    path = Path(text)
    if path.suffix in {form.ending for form in FORMATS.values()} and not path.exists():
        raise argparse.ArgumentTypeError(f"{quoted(text)} is to be a folder, for all files that are written")
    return output_folder(text)


def add_format(parser: argparse.ArgumentParser) -> None:
    """--format, of the files of signals."""
    meanings = "; ".join(f"{name}: {form.meaning}" for name, form in FORMATS.items())
    parser.add_argument(
        "--format", choices=FORMATS, default="csv", help=f"of the signals (default: %(default)s); {meanings}"
    )


def add_figures(parser: argparse.ArgumentParser) -> None:
    """--figures and --window, of the figures."""
    kinds = "; ".join(f"{kind}: {meaning}" for kind, meaning in KINDS.items())
    parser.add_argument(
        "--figures",
        action="append",
        choices=KINDS,
        help=f"kind of the figures' files (repeatable; default: {' and '.join(USUAL_KINDS)}); {kinds}",
    )
    parser.add_argument(
        "--window",
        type=window,
        metavar="FROM,TO",
        help="from and to when in s the figures show the signals (default: what suits each figure)",
    )


def figure_options(args: argparse.Namespace, caption: str, *spans: tuple[str, float, float]) -> FigureOptions:
    """What the options of `add_figures` say.

    Args:
        caption: of the figures.
        spans: what the figures show, in words, and from and to when in s there is something to be seen.

    Raises:
        DrivelineError: the window shows nothing of one of them.
    """
    for what, start, end in spans if args.window else ():
        if not (args.window[0] < end and args.window[1] > start):
            given = ",".join(f"{t:g}" for t in args.window)
            raise DrivelineError(f"--window {given}: {what} is from {start:g} to {end:g} s")
    return FigureOptions(caption, args.window, tuple(dict.fromkeys(args.figures or USUAL_KINDS)))


def window(text: str) -> tuple[float, float]:
    """Two times in s, the earlier one first."""
    start, end = (real(part.strip()) for part in (text.partition(",")[0], text.partition(",")[2]))
    if start is None or end is None or not (isfinite(start) and isfinite(end) and end - start >= LEAST_WINDOW):
        raise argparse.ArgumentTypeError(
            f"{quoted(text)} is not of the form 1.0,2.5, two times in s at least {LEAST_WINDOW:g} s apart"
        )
    return start, end


def add_report(parser: argparse.ArgumentParser) -> None:
    """--report, one page with all that the command has found."""
    parser.add_argument(
        "--report",
        type=Path,
        metavar="FILE.html",
        help="one page to send to others: verdict, tables, figures to zoom, what made it (docs/report.md)",
    )


def add_replace(parser: argparse.ArgumentParser) -> None:
    """--replace, without which results of another run stay."""
    parser.add_argument("--replace", action="store_true", help="replace results that are those of another run")


def add_printing(parser: argparse.ArgumentParser, table: bool = False) -> None:
    """--quiet and, of a command that prints a table, --json."""
    parser.add_argument("--quiet", action="store_true", help="print only what goes wrong")
    if table:
        add_json(parser)


def add_json(parser: argparse._ActionsContainer) -> None:
    """--json, of a command that prints a table."""
    parser.add_argument("--json", action="store_true", help="print one JSON document in the place of the table")


def assignment(text: str) -> tuple[str, float]:
    """`instance.parameter` and value of `instance.parameter=value`; true and false are 1 and 0."""
    name, equals, value = (part.strip() for part in text.partition("="))
    instance, dot, parameter = name.partition(".")
    number = {"true": 1.0, "false": 0.0}.get(value.lower(), real(value))
    if not (instance and dot and parameter and equals) or number is None:
        form = "INSTANCE.PARAMETER@TIME=VALUE, as controller.k_d@2.0=1.5" if "@" in name else "plant.J_1=0.06"
        raise argparse.ArgumentTypeError(f"{quoted(text)} is not of the form {form}")
    if not isfinite(number):
        raise argparse.ArgumentTypeError(f"{quoted(text)}: a parameter is a finite number")
    return name, number


def seed(text: str) -> int:
    """A whole number that all blocks with noise take."""
    from ...fmus.building.parameter_files import seeds  # not for help

    return count(text, *seeds())


def count(text: str, least: int, most: int) -> int:
    """A whole number between these."""
    number = whole(text, len(str(most)))
    if number is None or not least <= number <= most:
        raise argparse.ArgumentTypeError(f"{quoted(text)} is not a whole number from {least} to {most}")
    return number


def seconds(text: str) -> float:
    """A time above 0 s."""
    number = real(text)
    if number is None or not (isfinite(number) and number > 0.0):
        raise argparse.ArgumentTypeError(f"{quoted(text)} is not a time above 0 s")
    return number


def finite(text: str) -> float:
    """A finite number."""
    number = real(text)
    if number is None or not isfinite(number):
        raise argparse.ArgumentTypeError(f"{quoted(text)} is not a finite number")
    return number


def amount(text: str) -> float:
    """A finite number that is 0 or more."""
    number = finite(text)
    if number < 0.0:
        raise argparse.ArgumentTypeError(f"{quoted(text)} is below 0")
    return number


def megabytes(text: str) -> int:
    """A size above 0 MB, in bytes; of a part of a byte the whole."""
    number = real(text)
    if number is None or not (isfinite(number * 1e6) and number > 0.0):
        raise argparse.ArgumentTypeError(f"{quoted(text)} is not a size above 0 MB")
    return ceil(number * 1e6)
