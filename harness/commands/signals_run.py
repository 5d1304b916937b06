"""Commands that make one run of the loop and write its signals, and the frames of its bus."""

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from toolground.arguments import option, record
from toolground.errors import UserError
from toolground.optional_packages import required

from ..loop.places import PLACES
from ..manoeuvres.manoeuvre import Manoeuvre
from .jobs import RunJob, distinguishing, job
from .options import Loop, Replacing, SignalsFormat, controller, output, plant

if TYPE_CHECKING:
    from fmuloop.results import Results

    from ..loop.resolved import ResolvedLoop

SENDERS = ("can", "motor")
"""The places whose blocks declare frames."""


def control(default: str) -> Any:
    """--control."""
    return option(default, "active damping (default: %(default)s)", choices=("on", "off"))


@record
class OneRun(Loop, Replacing, SignalsFormat):
    """Of a command that makes one run."""

    plant: str = plant()
    control: str = control("on")
    controller: str = controller()
    output: Path = output("results", "the signals")
    frames: str | None = option(None, "log the frames of the bus too, with its DBC", choices=("asc", "blf"))


@contextmanager
def signals_job(
    args: OneRun, resolved: "ResolvedLoop", manoeuvre: Manoeuvre, run: Mapping[str, Any], read: Iterable[Path] = ()
) -> Iterator[tuple[RunJob, Path]]:
    """As `harness.commands.jobs.job`, with the path of the files without their endings, PLANT_MANOEUVRE_CONTROLLER, or
    without damping PLANT_MANOEUVRE_off, of a controller that is not the usual one PLANT_MANOEUVRE_CONTROLLER_off.

    Args:
        run: what distinguishes it beside settings, manoeuvre and format.

    Raises:
        UserError: there are results of another run, or no frames where --frames asks for them.
    """
    from ..views.signals_file import signals_path

    given = resolved.settings
    if args.frames:
        _require_frames(args, resolved.system.own)
    ends = [] if given.controller_name == PLACES["controller"][0] and not given.control else [given.controller_name]
    stem = args.output / "_".join([given.plant_name, manoeuvre.name, *ends, *([] if given.control else ["off"])])
    same = {**run, "damping": args.control} | distinguishing(resolved, manoeuvre) | args.other_format
    record, signals = stem.with_name(f"{stem.name}.json"), signals_path(stem, args.format)
    with job(args, record, same, {given.plant_name: resolved.fit}, [signals], read) as made:
        yield made, stem


def write_frames(resolved: "ResolvedLoop", results: "Results", stem: Path, ending: str) -> tuple[Path, Path]:
    """Writes the frames of a run as a log of the bus, and its database; returns the files."""
    from ..exchange.bus.database import telegrams, write_dbc
    from ..exchange.bus.log import write_log

    sent = telegrams(resolved.fit.parameters(resolved.settings.parameters))
    log, database = (stem.with_name(f"{stem.name}.{each}") for each in (ending, "dbc"))
    write_log(sent, results, log)
    write_dbc(sent, database)
    return log, database


def _require_frames(args: OneRun, own: frozenset[str]) -> None:
    """
    Args:
        own: the places in which there are blocks of ours.

    Raises:
        UserError: there are FMUs in the loop that declare no frames.
        MissingExtra: the packages are not installed.
    """
    if others := [place for place in SENDERS if place not in own]:
        raise UserError(f"--frames: {', '.join(getattr(args, place) for place in others)} declares no frames")
    for package in ("can", "cantools"):
        required(package, "a log of the bus", "driveline-damping[recordings]")
