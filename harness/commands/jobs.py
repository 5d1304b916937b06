"""What commands that write results share: what runs is recorded, the files are named, and what was found is told."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from toolground.printing import Printing

from ..loop.topology import ONE_UNIT
from ..manoeuvres.manoeuvre import Manoeuvre

if TYPE_CHECKING:
    from fmuloop.results import Results
    from fmuloop.wiring import Fit

    from ..loop.resolved import ResolvedLoop
    from ..simulation.case_archive import Campaign, CaseArchive, Table
    from ..simulation.provenance import Made


M = TypeVar("M", "Made", "Campaign[Any, Any]")


class Job(Generic[M]):
    """What a command makes, see `job` and `campaign_job`."""

    _made: M
    _content: Callable[[], Any]

    def __init__(self, out: Printing, reports: Iterable[Path]) -> None:
        self._out = out
        self._reports = reports
        self._show: Callable[[], None] = lambda: None
        self._document: dict[str, Any] = {}

    def start(self, made: M, content: Callable[[], Any]) -> None:
        """What is made is recorded from here on; `content` gives what made it."""
        self._made, self._content = made, content

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
        if not self._out.silent:
            self._show()
        self._out.written([*self._made.files, record])
        self._out.document(self._document | {"files": self._made.files})


class RunJob(Job["Made"]):
    """A job whose runs are all made anew."""

    def found(self, runs: "Mapping[str, Results]") -> None:
        """The record tells what is to be remarked of runs, by their names."""
        if remarks := {name: run.remarks for name, run in runs.items() if run.remarks}:
            self._made.found["remarks"] = remarks

    def begin(self, *others: Path) -> None:
        """See `harness.simulation.provenance.Made.begin`."""
        self._made.begin(*others)


@contextmanager
def job(
    args: Any,
    record: Path,
    run: Mapping[str, Any],
    fits: "Mapping[str, Fit]",
    results: Sequence[Path] = (),
    read: Iterable[Path] = (),
) -> Iterator[RunJob]:
    """Within it a command makes its runs and writes their files; then what made them is recorded, and all is told.

    Args:
        args: the record of the command, with `replace`, and with `report` if it has that.
        record: the JSON file beside the results.
        run: all that distinguishes it.
        fits: the systems that run, by their names.
        results: files that it will write, as far as their names are known.
        read: files that it reads beside the FMUs and those of --vehicle and --parameters.

    Raises:
        UserError: there are results of another run; nothing has been run.
    """
    from ..simulation.provenance import content, recorded

    reports, inputs = _reports(args), [*read, *_files(args)]
    one = RunJob(args, reports)
    with recorded(record, run, fits, inputs, [*results, *reports], args.replace) as made:
        _warn_of_absent(args, fits)
        one.start(made, lambda: content(run, fits, [], inputs, made.found))
        yield one
    one.end(record)


@contextmanager
def campaign_job(
    args: Any,
    record: Path,
    path: Path,
    table: "Table[Any, Any]",
    run: Mapping[str, Any],
    fits: "Mapping[str, Fit]",
) -> "Iterator[tuple[Job[Campaign[Any, Any]], CaseArchive[Any, Any]]]":
    """Within it a command runs the cases of a campaign that are not in its archive yet; else as `job`.

    Args:
        path: of the archive.
        table: what the lines of the archive are.

    Raises:
        UserError: there are results of another campaign; nothing has been run.
    """
    from ..simulation.case_archive import resumable

    reports = _reports(args)
    _warn_of_absent(args, fits)
    one: Job[Campaign[Any, Any]] = Job(args, reports)
    with resumable(path, table, record, run, fits, _files(args), reports, args.replace) as made:
        one.start(made, lambda: made.provenance)
        yield one, made.archive
    one.end(record)


def distinguishing(resolved: "ResolvedLoop", manoeuvre: Manoeuvre | None = None) -> dict[str, Any]:
    """What distinguishes a run of the loop from others: all that was set, and the FMUs: ours by the start values
    that they were built with, others by their content.

    Args:
        manoeuvre: None: several.
    """
    from fmublocks.origin import origin_of
    from toolground.digest import digest

    from ..loop.fmu_cache import as_built
    from ..simulation.simulate import start

    system, made = resolved.system, resolved.settings
    ours = {name: origin_of(path) for name, path in system.instances.items() if name in system.own}
    others = {name: path for name, path in system.instances.items() if name not in system.own}
    own = start(manoeuvre, made.seed, made.topology) if manoeuvre else {}
    digests = {name: digest(path) for name, path in others.items() if path.is_file()}
    return {
        "fmus": {name: str(as_built(path)) for name, path in system.instances.items()},
        "start_values": {name: origin.start_values for name, origin in ours.items() if origin},
        **({"digests": digests} if digests else {}),
        "parameters": {**own, **made.parameters},
        **({"road_load": made.road_load} if made.road_load else {}),
        **({"frequency": made.frequency} if made.frequency else {}),
        **({"topology": made.topology.units} if made.topology != ONE_UNIT else {}),
        "seed": made.seed,
        "mapping": made.mapping,
    }


def _warn_of_absent(args: Printing, fits: "Mapping[str, Fit]") -> None:
    """Before any worker does: once a command, and with --quiet not at all."""
    from fmuloop.loading import warn_of_absent
    from toolground.collected_warnings import as_if_logged

    with as_if_logged(args.quiet):
        for fitted in fits.values():
            warn_of_absent(fitted)


def _reports(args: Any) -> list[Path]:
    return [args.report] if getattr(args, "report", None) else []


def _files(args: Any) -> list[Path | None]:
    return [getattr(args, name, None) for name in ("vehicle", "parameters")]
