"""Runs ten manoeuvres, or those that are given, on every plant twice, with the damping off and on, and prints one
table, which goes to table.md in the output folder; all metrics go to metrics.csv, the signals of every run to runs/.

{metrics}

Metrics that make no sense for a manoeuvre, such as the settling of a pulse, are a dash. If none are given: {compared}.

examples:
  driveline compare --plant ValidationVehicle --manoeuvre tipin15 --manoeuvre drive
  driveline compare --plant my_vehicle.fmu --set controller.k_d=1.5 --seed 7 --output results/mine
  driveline compare --manoeuvre examples/manoeuvres/overtaking.toml --window 0.95,1.3 --figures svg
  driveline compare --report comparison.html --json > comparison.json
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..loop.settings import Settings
from ..manoeuvres.catalogue import COMPARED
from ..manoeuvres.manoeuvre import Manoeuvre
from ..metrics.run_metrics import Metrics
from ..views.metrics_table import legend
from .jobs import RunJob, distinguishing, job
from .lacking import lacking_line
from .manoeuvres import Chosen, Listing, chosen, manoeuvre
from .options import Figures, Loop, Replacing, Report, SignalsFormat, controller, output, plants, record
from .printing import JsonPrinting
from .settings import caption, dampings, plants_settings

if TYPE_CHECKING:
    from ..studies.compare.compare import Case, Outcome

IN_HELP = {"metrics": legend(Metrics), "compared": ", ".join(COMPARED)}

TABLES = ("table.md", "metrics.csv")


@record
class Arguments(Listing, Loop, Replacing, SignalsFormat, Figures, Report, JsonPrinting):
    manoeuvre: Chosen = manoeuvre("only this one of --list, or that of a file (repeatable; default: ten)")
    plant: tuple[str, ...] = plants()
    controller: str = controller()
    output: Path = output("results/compare", "tables, figures and the signals of every run")


def run(args: Arguments) -> int:
    by_name = plants_settings(args)
    # here and not above: mistakes and help are answered without them
    from ..manoeuvres.drivable import require_possible
    from ..studies.compare.compare import cases, run_cases, write_figures, write_tables
    from ..views.signals_file import signals_path
    from ..views.terminal import print_runs

    requested = args.manoeuvre if args.manoeuvre.manoeuvres else chosen(COMPARED)
    requested = requested.for_car(next(iter(by_name.values())).parameters)
    given = {str(each.plant): each for each in by_name.values()}
    manoeuvres, read = requested.manoeuvres, list(requested.files.values())
    options = args.options(caption(args), *((each.name, 0.0, each.duration) for each in manoeuvres.values()))
    same: dict[str, Any] = {name: distinguishing(each) for name, each in by_name.items()}
    same |= {"manoeuvres": list(manoeuvres)} | requested.digests | args.other_format
    runs = {case: args.output / "runs" / case.file_name for case in cases(list(given), list(manoeuvres))}
    signals = {case: signals_path(stem, args.format) for case, stem in runs.items()}
    with job(args, args.output / "compare.json", same, by_name, [args.output / name for name in TABLES], read) as made:
        require_possible(*requested, made.fits, by_name)
        made.begin(*signals.values(), *(path.with_suffix(".json") for path in signals.values()))
        outcomes = run_cases(list(runs), args.output / "runs", given, manoeuvres, args.format)
        title = dampings(next(iter(given.values())))
        made.wrote(
            *write_tables(outcomes, args.output, title), *write_figures(outcomes, args.output, options, manoeuvres)
        )
        for case, path in signals.items():
            _record(made, case, path, given[case.plant], manoeuvres[case.manoeuvre], read)
        for provenance, path in made.reports():
            _report(outcomes, manoeuvres, given, provenance, path)
        builds = ", ".join(f"{each.plant_name} {each.build}" for each in given.values())
        args.say(f"FMUs: {builds}; signals of {len(outcomes)} runs: {args.output / 'runs'}")
        if lacks := lacking_line(args.vehicle):
            args.say(lacks)
        made.tell(print_runs, [each.row for each in outcomes], title, runs=[each.record for each in outcomes])
    return 0


def _record(
    made: RunJob, case: "Case", signals: Path, settings: Settings, manoeuvre: Manoeuvre, read: Sequence[Path]
) -> None:
    """Writes what made the signals of a run beside them."""
    from ..simulation.provenance import write_record

    one = {"manoeuvre": case.manoeuvre, "damping": "on" if case.control else "off"}
    fits = {case.plant_name: made.fits[case.plant_name]}
    write_record(signals.with_suffix(".json"), one | distinguishing(settings, manoeuvre), fits, [signals], read)


def _report(
    outcomes: "Sequence[Outcome]",
    manoeuvres: Mapping[str, Manoeuvre],
    given: Mapping[str, Settings],
    provenance: Mapping[str, Any],
    path: Path,
) -> None:
    from ..studies.compare import compare_report

    runs = [(each.row, each.results) for each in outcomes]
    controllers = [Path(each.controller).stem for each in given.values()]
    compare_report.report(runs, manoeuvres, controllers, provenance, path)
