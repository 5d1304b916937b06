"""`driveline compare`: what active damping does, on both plants and on all manoeuvres."""

import argparse
from pathlib import Path
from typing import Any

from ..loop.built_fmus import built
from ..loop.places import PLANTS
from ..manoeuvres.catalogue import COMPARED
from ..metrics.run_metrics import Metrics
from ..views.html.report_page import require_report
from ..views.metrics_table import legend, reasons
from .manoeuvres import OWN, add_manoeuvre, chosen, digests, files, require_files_drivable
from .options import add_figures, add_format, add_loop, add_output, add_plant, add_printing, add_report, figure_options
from .printing import Printer
from .settings import blocks, caption, distinguishing, other_format, settings

LEGEND = legend(Metrics)

DESCRIPTION = f"""\
Runs every manoeuvre on every plant twice, with the damping off and on, and prints one table:

{LEGEND}

--manoeuvre also takes {OWN};
metrics that make no sense for it, such as the settling of a pulse, are a dash.

The table goes to table.md in the output folder, all metrics to metrics.csv, the figures beside them and the
signals of every run to runs/.
"""

EXAMPLES = """\
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
    plants = list(dict.fromkeys(args.plant or PLANTS))
    builds = {plant: built(plant, args.fmus, args.build, **blocks(args)) for plant in plants}
    # here and not above: mistakes and help are answered without them
    from ..simulation.provenance import content, recorded, write_record
    from ..simulation.simulate import looped
    from ..studies.compare.compare import cases, run_cases, write_figures, write_tables
    from ..views.signals_file import require_format, signals_path
    from ..views.terminal import print_table, runs_table

    out = Printer(args)
    requested = args.manoeuvre or COMPARED
    manoeuvres = chosen(requested)
    drawing = figure_options(args, caption(args), *((each.name, 0.0, each.duration) for each in manoeuvres.values()))
    todo = cases(plants, list(manoeuvres))
    given = {plant: settings(args, plant, build) for plant, build in builds.items()}
    systems = {plant: looped(plant, given[plant]) for plant in plants}
    record, tables = args.output / "compare.json", [args.output / name for name in ("table.md", "metrics.csv")]
    same: dict[str, Any] = {Path(plant).stem: distinguishing(given[plant], systems[plant], None) for plant in plants}
    same |= {"manoeuvres": list(manoeuvres)} | digests(requested) | other_format(args)
    by_name = {Path(plant).stem: system for plant, system in systems.items()}
    read = [*files(requested).values(), args.vehicle, args.parameters]
    signals = {case: signals_path(args.output / "runs" / case.file_name, args.format) for case in todo}
    require_format(args.format)
    report = [args.report] if args.report else []
    with recorded(record, same, by_name, read, [*tables, *report], args.replace) as made:
        for plant in plants:
            require_files_drivable(requested, manoeuvres, made.fits[Path(plant).stem], given[plant]["parameters"])
        made.begin(*(path.with_suffix(".json") for path in signals.values()))
        outcomes = run_cases(todo, args.output / "runs", given, manoeuvres, args.format)
        rows = [outcome.row for outcome in outcomes]
        if not out.silent:
            print_table(runs_table(rows))
        for reason in reasons(rows):
            out.say(reason)
        out.say(f"{LEGEND}\n")
        tables = write_tables(outcomes, args.output)
        figures = write_figures(outcomes, args.output, drawing, manoeuvres)
        made.files += [*tables, *figures]
        for case, path in signals.items():
            own = distinguishing(given[case.plant], systems[case.plant], manoeuvres[case.manoeuvre])
            one = {"manoeuvre": case.manoeuvre, "damping": "on" if case.control else "off"} | own
            write_record(path.with_suffix(".json"), one, {case.plant_name: made.fits[case.plant_name]}, [path], read)
        if args.report:
            from ..studies.compare import compare_report as page

            runs = [(outcome.row, outcome.results) for outcome in outcomes]
            page.report(runs, manoeuvres, content(same, made.fits, [], read), args.report)
            made.files += report
    out.say(f"FMUs:    {', '.join(f'{Path(plant).stem} {build}' for plant, build in builds.items())}")
    out.say(f"tables:  {' '.join(map(str, tables))}")
    kind, *others = drawing.kinds
    beside = f" (and {', '.join(f'.{other}' for other in others)})" if others else ""
    for figure in figures:
        if figure.suffix == f".{kind}":
            out.say(f"figure:  {figure}{beside}")
    out.say(f"signals: {args.output / 'runs'}/*{next(iter(signals.values())).suffix} ({len(outcomes)} runs)")
    for path in report:
        out.say(f"report:  {path}")
    out.say(f"made by: {record} (version, FMUs, parameters, units), and one beside the signals of every run")
    out.document({"runs": [outcome.record for outcome in outcomes], "files": made.files})
    return 0
