"""`driveline compare`: what active damping does, on both plants and on all manoeuvres."""

import argparse
from pathlib import Path
from typing import Any

from ..control_loop import PLANTS
from ..manoeuvres.catalogue import COMPARED, MANOEUVRES
from ..metrics.record import Metrics
from ..reports.table import legend, reasons
from .built import built
from .options import add_loop, add_output, add_plant, add_printing
from .printing import Printer
from .settings import blocks, caption, distinguishing, settings

LEGEND = legend(Metrics)

DESCRIPTION = f"""\
Runs every manoeuvre on every plant twice, with the damping off and on, and prints one table:

{LEGEND}

It goes to table.md in the output folder, all metrics to metrics.csv, the figures beside them and the
signals of every run to runs/.
"""

EXAMPLES = """\
examples:
  driveline compare
  driveline compare --plant ValidationVehicle --manoeuvre tipin15 --manoeuvre drive
  driveline compare --plant my_vehicle.fmu --seed 7 --output results/mine
  driveline compare --set controller.k_d=1.5 --output results/softer
  driveline compare --json > comparison.json
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--manoeuvre",
        action="append",
        choices=MANOEUVRES,
        metavar="NAME",
        help=f"only this manoeuvre (repeatable); default: {', '.join(COMPARED)}",
    )
    add_plant(parser, several=True)
    add_loop(parser)
    add_output(parser, "results/compare", "tables, figures and the signals of every run", of_a_run=True)
    add_printing(parser, table=True)


def run(args: argparse.Namespace) -> int:
    plants = list(dict.fromkeys(args.plant or PLANTS))
    builds = {plant: built(plant, args.fmus, args.build, **blocks(args)) for plant in plants}
    # here and not above: mistakes and help are answered without them
    from ..compare import cases, run_cases, write_figures, write_tables
    from ..provenance import recorded, write_record
    from ..reports.terminal import print_table, runs_table
    from ..simulate import looped

    out = Printer(args)
    todo = cases(plants, list(dict.fromkeys(args.manoeuvre or COMPARED)))
    given = {plant: settings(args, plant, build) for plant, build in builds.items()}
    systems = {plant: looped(plant, given[plant]) for plant in plants}
    record, tables = args.output / "compare.json", [args.output / name for name in ("table.md", "metrics.csv")]
    same: dict[str, Any] = {Path(plant).stem: distinguishing(given[plant], systems[plant], None) for plant in plants}
    same["manoeuvres"] = list(dict.fromkeys(case.manoeuvre for case in todo))
    by_name, read = {Path(plant).stem: system for plant, system in systems.items()}, [args.vehicle, args.parameters]
    signals = {case: args.output / "runs" / f"{case.file_name}.csv" for case in todo}
    with recorded(record, same, by_name, read, tables, args.replace) as made:
        made.begin(*(path.with_suffix(".json") for path in signals.values()))
        outcomes = run_cases(todo, args.output / "runs", given)
        rows = [outcome.row for outcome in outcomes]
        if not out.silent:
            print_table(runs_table(rows))
        for reason in reasons(rows):
            out.say(reason)
        out.say(f"{LEGEND}\n")
        tables, figures = write_tables(outcomes, args.output), write_figures(outcomes, args.output, caption(args))
        made.files += [*tables, *figures]
        for case, path in signals.items():
            own = distinguishing(given[case.plant], systems[case.plant], MANOEUVRES[case.manoeuvre])
            one = {"manoeuvre": case.manoeuvre, "damping": "on" if case.control else "off"} | own
            write_record(path.with_suffix(".json"), one, {case.plant_name: made.fits[case.plant_name]}, [path], read)
    out.say(f"FMUs:    {', '.join(f'{Path(plant).stem} {build}' for plant, build in builds.items())}")
    out.say(f"tables:  {' '.join(map(str, tables))}")
    for figure in figures:
        if figure.suffix == ".png":
            out.say(f"figure:  {figure} (and .pdf)")
    out.say(f"signals: {args.output / 'runs'}/*.csv ({len(outcomes)} runs)")
    out.say(f"made by: {record} (version, FMUs, parameters, units), and one beside the signals of every run")
    out.document({"runs": [outcome.record for outcome in outcomes], "files": made.files})
    return 0
