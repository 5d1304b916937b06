"""The course that commands share: what runs is recorded, the files are named, and what was found is told."""

import argparse
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from ..base.errors import DrivelineError
from ..loop.settings import Settings, loop
from .printing import Printer

if TYPE_CHECKING:
    from ..cosimulation.system import System
    from ..cosimulation.wiring import Fit
    from ..simulation.case_archive import Campaign, CaseArchive, Table
    from ..simulation.provenance import Made


def command(name: str) -> ModuleType:
    """The module of a command."""
    return import_module(f".{name.replace('-', '_')}", __package__)


def run(args: argparse.Namespace) -> int:
    """Runs the command of the arguments; returns its exit code.

    Raises:
        DrivelineError: the user can mend what is wrong.
    """
    from ...fmus.errors import BuildError

    if getattr(args, "list", False):
        from .manoeuvres import print_manoeuvres

        print_manoeuvres(getattr(args, "json", False))
        return 0
    try:
        return command(args.module).run(args)
    except BuildError as refusal:
        raise DrivelineError(str(refusal)) from refusal


class Job:
    """What a command makes, see `job` and `campaign_job`.

    Attributes:
        out: prints.
    """

    def __init__(
        self, out: Printer, made: "Made | Campaign[Any, Any]", reports: Iterable[Path], content: Callable[[], Any]
    ) -> None:
        self.out = out
        self._made = made
        self._reports = reports
        self._content = content
        self._show: Callable[[], None] = lambda: None
        self._document: dict[str, Any] = {}

    def wrote(self, *files: Path) -> None:
        """These files are results."""
        self._made.files += files

    def reports(self) -> Iterator[tuple[dict[str, Any], Path]]:
        """Where the page of --report goes, if one is asked for, with what made the results, for the page."""
        for path in self._reports:
            yield self._content(), path
            self.wrote(path)

    def tell(self, show: Callable[..., None], *found: Any, **document: Any) -> None:
        """What is told at the end: for people what `show` prints of what was found, for tools the document."""
        self._show, self._document = partial(show, *found), document

    def end(self, record: Path) -> None:
        """Tells it, and which files there are."""
        if not self.out.silent:
            self._show()
        self.out.files([*self._made.files, record])
        self.out.document(self._document | {"files": self._made.files})


class RunJob(Job):
    """A job whose runs are all made anew.

    Attributes:
        begin: see `harness.simulation.provenance.Made.begin`.
        fits: the systems that run, by their names.
    """

    def __init__(self, out: Printer, made: "Made", reports: Iterable[Path], content: Callable[[], Any]) -> None:
        super().__init__(out, made, reports, content)
        self.begin = made.begin
        self._run = made

    @property
    def fits(self) -> "Mapping[str, Fit]":
        return self._run.fits


@contextmanager
def job(
    args: argparse.Namespace,
    record: Path,
    run: Mapping[str, Any],
    systems: "Mapping[str, Settings | System]",
    results: Sequence[Path] = (),
    read: Sequence[Path] = (),
) -> Iterator[RunJob]:
    """Within it a command makes its runs and writes their files; then what made them is recorded, and all is told.

    Args:
        args: with --replace, and --report if the command has that.
        record: the JSON file beside the results.
        run: all that distinguishes it.
        systems: that run, or the settings of the loops that run, by their names.
        results: files that it will write, as far as their names are known.
        read: files that it reads beside the FMUs and those of --vehicle and --parameters.

    Raises:
        DrivelineError: there are results of another run; nothing has been run.
    """
    from ..simulation.provenance import content, recorded

    reports, inputs, wired = _reports(args), [*read, *_files(args)], _wired(systems)
    with recorded(record, run, wired, inputs, [*results, *reports], args.replace) as made:
        one = RunJob(Printer(args), made, reports, lambda: content(run, made.fits, [], inputs))
        yield one
    one.end(record)


@contextmanager
def campaign_job(
    args: argparse.Namespace,
    record: Path,
    path: Path,
    table: "Table[Any, Any]",
    run: Mapping[str, Any],
    systems: "Mapping[str, Settings | System]",
) -> Iterator[tuple[Job, "CaseArchive[Any, Any]"]]:
    """Within it a command runs the cases of a campaign that are not in its archive yet; else as `job`.

    Args:
        path: of the archive.
        table: what the lines of the archive are.

    Raises:
        DrivelineError: there are results of another campaign; nothing has been run.
    """
    from ..simulation.case_archive import resumable

    reports = _reports(args)
    with resumable(path, table, record, run, _wired(systems), _files(args), reports, args.replace) as made:
        one = Job(Printer(args), made, reports, lambda: made.provenance)
        yield one, made.archive
    one.end(record)


def _reports(args: argparse.Namespace) -> list[Path]:
    return [args.report] if getattr(args, "report", None) else []


def _files(args: argparse.Namespace) -> list[Path | None]:
    return [getattr(args, name, None) for name in ("vehicle", "parameters")]


def _wired(systems: "Mapping[str, Settings | System]") -> "dict[str, System]":
    return {name: loop(each) if isinstance(each, Settings) else each for name, each in systems.items()}
