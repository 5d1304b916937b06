"""Runs ten manoeuvres, or those that are given, on every plant twice, with the damping off and on, and prints one
table:

{metrics}

--manoeuvre also takes {own};
metrics that make no sense for it, such as the settling of a pulse, are a dash.

The table goes to table.md in the output folder, all metrics to metrics.csv, the figures beside them and the
signals of every run to runs/.

examples:
  driveline compare
  driveline compare --plant ValidationVehicle --manoeuvre tipin15 --manoeuvre drive
  driveline compare --plant my_vehicle.fmu --seed 7 --output results/mine
  driveline compare --set controller.k_d=1.5 --output results/softer
  driveline compare --manoeuvre examples/manoeuvres/overtaking.toml --output results/overtaking
  driveline compare --manoeuvre tipin15 --window 0.95,1.3 --figures pdf --figures svg
  driveline compare --json > comparison.json
  driveline compare --report comparison.html
"""

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..loop.settings import Settings
from ..manoeuvres.catalogue import COMPARED
from ..manoeuvres.manoeuvre import Manoeuvre
from ..metrics.run_metrics import Metrics
from ..views.html.report_page import require_report
from ..views.metrics_table import legend
from .course import RunJob, job
from .manoeuvres import OWN, add_manoeuvre, chosen
from .options import add_figures, add_format, add_loop, add_output, add_plant, add_printing, add_report, figure_options
from .settings import caption, dampings, distinguishing, other_format, settings_of_plants

if TYPE_CHECKING:
    from ..studies.compare.compare import Case, Outcome

IN_HELP = {"metrics": legend(Metrics), "own": OWN}

TABLES = ("table.md", "metrics.csv")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    names = ", ".join(COMPARED)
    add_manoeuvre(parser, f"only this manoeuvre, or that of a file (repeatable); default: {names}", action="append")
    add_plant(parser, several=True)
    add_loop(parser)
    add_output(parser, "results/compare", "tables, figures and the signals of every run", of_a_run=True)
    add_format(parser)
    add_figures(parser)
    add_report(parser)
    add_printing(parser, table=True)


def run(args: argparse.Namespace) -> int:
    require_report(args.report)
    given = settings_of_plants(args)
    # here and not above: mistakes and help are answered without them
    from ..studies.compare.compare import cases, run_cases, write_figures, write_tables
    from ..views.signals_file import signals_path

    requested, by_name = chosen(args.manoeuvre or COMPARED), {each.plant_name: each for each in given.values()}
    manoeuvres, read = requested.manoeuvres, list(requested.files.values())
    options = figure_options(args, caption(args), *((each.name, 0.0, each.duration) for each in manoeuvres.values()))
    same: dict[str, Any] = {name: distinguishing(each) for name, each in by_name.items()}
    same |= {"manoeuvres": list(manoeuvres)} | requested.digests | other_format(args)
    runs = {case: args.output / "runs" / case.file_name for case in cases(list(given), list(manoeuvres))}
    signals = {case: signals_path(stem, args.format) for case, stem in runs.items()}
    with job(args, args.output / "compare.json", same, by_name, [args.output / name for name in TABLES], read) as made:
        requested.require_drivable(made.fits, by_name)
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
        _tell(made, outcomes, given, args.output / "runs", title)
    return 0


def _tell(made: RunJob, outcomes: "Sequence[Outcome]", given: Mapping[str, Settings], folder: Path, title: str) -> None:
    """The metrics of the runs, whose signals are in a folder."""
    from ..views.terminal import print_runs

    builds = ", ".join(f"{each.plant_name} {each.build}" for each in given.values())
    made.out.say(f"FMUs: {builds}; signals of {len(outcomes)} runs: {folder}")
    made.tell(print_runs, [each.row for each in outcomes], title, runs=[each.record for each in outcomes])


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
