"""The options that several commands have, as records that theirs inherit, each option with its check;
`harness.commands.settings` says what they mean."""

from argparse import ArgumentError, ArgumentTypeError, _AppendAction
from collections.abc import Mapping, Sequence
from math import isfinite
from pathlib import Path
from typing import Any

from fmuloop.limit_options import ForeignLimits
from toolground.argument_types import counted, file, folder, output_folder, written
from toolground.arguments import EXPERTS, expert, option, record
from toolground.errors import UserError
from toolground.known_names import nearest
from toolground.plain_text import plain, quoted
from toolground.written_numbers import real

from ..loop.parameter_words import FORMS, said
from ..loop.places import BUILD, BUILD_HELP, BUILDS, PLACES, PLANTS
from ..views.figure_options import KINDS, USUAL_KINDS, FigureOptions
from ..views.signals_file import FORMATS

LEAST_WINDOW = 0.01
"""In s, of the figures: a few samples."""


def seed(text: str) -> int:
    """A whole number that all blocks with noise take."""
    from ...fmus.building.parameter_files import seeds  # not for help

    return counted(*seeds())(text)


def window(text: str) -> tuple[float, float]:
    """Two times in s, the earlier one first."""
    start, end = (real(part.strip()) for part in (text.partition(",")[0], text.partition(",")[2]))
    if start is None or end is None or not (isfinite(start) and isfinite(end) and end - start >= LEAST_WINDOW):
        raise ArgumentTypeError(
            f"{quoted(text)} is not of the form 1.0,2.5, two times in s at least {LEAST_WINDOW:g} s apart"
        )
    return start, end


def assignment(text: str) -> tuple[str, float]:
    """`instance.parameter` and value of `instance.parameter=value`; true and false are 1 and 0."""
    name, equals, value = (part.strip() for part in text.partition("="))
    instance, dot, parameter = name.partition(".")
    found = {"true": 1.0, "false": 0.0}.get(value.lower(), real(value))
    if not (instance and dot and parameter and equals) or found is None:
        form = FORMS["changed" if "@" in name else "constant"]
        raise ArgumentTypeError(said("form", text=quoted(text), form=form))
    if not isfinite(found):
        raise ArgumentTypeError(said("finite", text=quoted(text)))
    return name, found


class Assigned(_AppendAction):
    """Appends a parameter with its value, of which there is one."""

    def __call__(self, parser, namespace, values, option_string=None) -> None:
        name, value = values  # type: ignore[misc]
        if (before := dict(getattr(namespace, self.dest)).get(name, value)) != value:
            raise ArgumentError(self, said("twice", name=name, before=repr(before), value=repr(value)))
        super().__call__(parser, namespace, values, option_string)


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


def block(place: str, default: str | None, help: str, group: str | None = None) -> Any:
    """What stands in a place of the loop; `default` is the one that is usual, or None: several can be given."""
    names = PLACES[place]
    complete = names_or_files(names, ("fmu",), "block")
    return option(() if default is None else default, help, metavar="NAME|FILE", complete=complete, group=group)


def plant(default: str = PLANTS[0]) -> Any:
    """--plant, of one plant."""
    return block("plant", default, f"{' or '.join(PLANTS)}, or an FMU (default: %(default)s)")


def plants() -> Any:
    """--plant, of several."""
    return block("plant", None, f"{' or '.join(PLANTS)}, or an FMU (repeatable; default: both)")


def controller() -> Any:
    """--controller, of one controller."""
    help = "damping control: DampingController (default), a comparator of `driveline build --help`, or an FMU"
    return block("controller", PLACES["controller"][0], help)


def controllers(default: str) -> Any:
    """--controller, of several; `default` says which they are if none is given."""
    return block("controller", None, f"by name or an FMU (repeatable; default: {default})")


def file_of(help: str) -> Any:
    """The path of a TOML file."""
    return option(None, help, file, metavar="FILE.toml", complete="file")


@record
class ParameterFiles:
    """The files of `fmus.building.parameter_files`."""

    vehicle: Path | None = file_of("what belongs to the car, for every block that has it")
    parameters: Path | None = file_of("what is set in the controller, as `driveline design` writes it")


def _with_equations(text: str) -> str:
    names = PLACES["controller"]
    if Path(text).suffix == ".fmu":
        raise ArgumentTypeError(
            f"{text} does not tell its equations, nor in which range its parameters are searched: give the Python file "
            f"that it was built from, or one of {', '.join(names)} (`driveline compare` and `robustness` take any FMU)"
        )
    if text not in names and Path(text).suffix != ".py":
        raise ArgumentTypeError(f"{plain(text, 60)} is unknown; {nearest(text, names)} (or give a Python file)")
    return text


def _in_place(controller: str | None) -> str | None:
    if controller is None or Path(controller).suffix != ".py":
        return controller
    from ..loop.own_controller import with_equations  # not for help

    return with_equations(controller)


def controller_with_equations(default: str | None, help: str, group: str | None = None) -> Any:
    """--controller, of one whose equations are asked for: of the project, or in a Python file."""
    complete = names_or_files(PLACES["controller"], ("py",), "controller")
    how = {"metavar": "NAME|FILE.py", "complete": complete, "group": group}
    return option(default, help, _with_equations, read=_in_place, **how)


@record
class OurController(ParameterFiles):
    """A controller of the project, with the values of car and controller."""

    controller: str = option(
        PLACES["controller"][0], "damping control (default: %(default)s)", choices=PLACES["controller"], metavar="NAME"
    )


@record
class FmuFolder:
    """Where the FMUs are that run."""

    fmus: Path = expert(
        BUILD, "of the built FMUs, native ones in native/ (default: %(default)s)", folder, metavar="FOLDER"
    )


def _mapping(texts: tuple[str, ...]) -> Mapping[str, str]:
    from fmuloop.mapping import parsed

    return parsed(texts)


@record
class Loop(ParameterFiles, FmuFolder, ForeignLimits):
    """What every run of the loop can be given beside plant and controller."""

    set: tuple[tuple[str, float], ...] = option(
        (),
        "in SI units, over the files; with @TIME from then on (repeatable)",
        assignment,
        action=Assigned,
        metavar="INSTANCE.PARAMETER[@TIME]=VALUE",
    )
    seed: int = option(1, "of the sensor noise (default: %(default)s)", seed)
    motor: str = block("motor", PLACES["motor"][0], "%(default)s (default) or an FMU", EXPERTS)
    can: str = block("can", PLACES["can"][0], "wheel speeds over the bus: %(default)s (default) or an FMU", EXPERTS)
    map: Mapping[str, str] = expert(
        (),
        "what an FMU calls variables of the loop: a file, of which `driveline map` makes a draft, or as "
        "plant.T_gear=Shaft.tau (repeatable)",
        read=_mapping,
        metavar="FILE.toml|NAME=THEIRS",
    )
    build: str | None = expert(None, BUILD_HELP, choices=BUILDS)


@record
class DriveUnits:
    """Of a command that runs loops of several drive units too."""

    topology: Path | None = expert(
        None, "the drive units of the loop, if it has several (default: one)", file, metavar="FILE.toml"
    )


def _output(text: str) -> Path:
    """A folder; the name of a file of signals is a slip."""
    path = Path(text)
    if path.suffix in {".ssp", *(form.ending for form in FORMATS.values())} and not path.exists():
        raise ArgumentTypeError(f"{quoted(text)} is to be a folder, for all files that are written")
    return output_folder(text)


def output(default: str, files: str) -> Any:
    """--output, the folder for everything that the command writes, or the file; `files` says what that is."""
    ending = Path(default).suffix
    read, metavar = (written(ending, files), f"FILE{ending}") if ending else (_output, "FOLDER")
    return option(Path(default), f"for {files} (default: %(default)s)", read, metavar=metavar)


@record
class Replacing:
    """Without it results of another run stay."""

    replace: bool = option(False, "replace results that are those of another run")


def write_toml(text: str, path: Path, replace: bool) -> None:
    """Writes a vehicle file or one of gains; one with another content only if it may be replaced."""
    from toolground.atomic_files import write_text

    from ..simulation.provenance import require_same_text

    if not replace:
        require_same_text(text, path)
    write_text(text, path)


def _there(name: str) -> str:
    from ..views.signals_file import require_format

    require_format(name)
    return name


@record
class SignalsFormat:
    """Of the files of signals."""

    format: str = option("csv", "of the signals (default: %(default)s)", choices=FORMATS, read=_there)

    @property
    def other_format(self) -> dict[str, Any]:
        """What distinguishes a run by the format of its signals: nothing, if it is the usual one."""
        return {} if self.format == "csv" else {"format": self.format}


@record
class Figures:
    """How figures are drawn."""

    figures: tuple[str, ...] = option(
        (), f"their kind (repeatable; default: {' and '.join(USUAL_KINDS)})", choices=KINDS
    )
    window: tuple[float, float] | None = option(
        None, "from and to when in s the figures show the signals", window, metavar="FROM,TO"
    )

    def options(self, caption: str, *spans: tuple[str, float, float]) -> FigureOptions:
        """
        Args:
            caption: of the figures.
            spans: what the figures show, in words, and from and to when in s there is something to be seen.

        Raises:
            UserError: the window shows nothing of one of them.
        """
        for what, start, end in spans:
            if self.window and not (self.window[0] < end and self.window[1] > start):
                given = ",".join(f"{t:g}" for t in self.window)
                raise UserError(f"--window {given}: {what} is from {start:g} to {end:g} s")
        return FigureOptions(caption, self.window, tuple(dict.fromkeys(self.figures or USUAL_KINDS)))


def _drawable(path: Path | None) -> Path | None:
    from ..views.page.report import require_report

    require_report(path)
    return path


@record
class Report:
    """One page with all that the command has found."""

    report: Path | None = option(
        None, "one page to send to others: verdict, tables, figures to zoom", Path, read=_drawable, metavar="FILE.html"
    )


def cases(default: int, most: int) -> Any:
    """--cases."""
    return option(default, "how many (default: %(default)s)", counted(1, most), metavar="COUNT")


def case(most: int, help: str) -> Any:
    """--case."""
    return option(None, help, counted(1, most), metavar="NUMBER")


@record
class Campaign(Loop, DriveUnits, Replacing, Report):
    """Of a command that runs many cases, or one of them again."""

    plant: tuple[str, ...] = plants()
    cases: int = cases(1, 1)
    case: int | None = case(1, "only the case of this number")
    scheduler: str | None = expert(None, "of a Dask cluster that runs the cases", metavar="ADDRESS")
