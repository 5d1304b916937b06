"""`driveline compare`: what active damping does, on both plants and on all manoeuvres."""

import argparse
from pathlib import Path

from rich.progress import track

from ..compare import cases, run_cases, write_figures, write_tables
from ..cosimulation.system import BUILD_HELP, BUILDS, PLANTS, chosen_build
from ..errors import DrivelineError
from ..manoeuvres.catalogue import COMPARED, MANOEUVRES
from ..names import nearest
from ..reports.terminal import runs_table, wide_console

NAME = "compare"
HELP = "run the manoeuvres without and with damping and compare"

DESCRIPTION = """\
Runs every manoeuvre on every plant twice, with the damping off and on, and prints one table:

  settling         until the gear torque swings by less than 5 % of the demanded step
  overshoot        of the gear torque over its final value
  damping ratio    from the decrement of the gear torque
  torque, jerk     rms between 5 and 50 Hz of the gear torque, which wears the gear, and of the
                   jerk of the body, which the passengers feel
  impact speed     with which the teeth meet after the backlash
  delay to 90 %    until the gear torque has made 90 % of its way
  torque withheld  impulse taken from the driver over the step: a lag by that time
  stat. change     mean torque that the damping adds at the end, when all is quiet
"""

EXAMPLES = """\
examples:
  driveline compare
  driveline compare --plant ValidationVehicle --manoeuvre tipin15 --manoeuvre drive
  driveline compare --plant my_vehicle.fmu --seed 7 --output results/mine
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--plant",
        action="append",
        metavar="NAME|FILE",
        help=f"only this plant, {' or '.join(PLANTS)} or an FMU with the same interface (repeatable)",
    )
    parser.add_argument(
        "--manoeuvre",
        action="append",
        metavar="NAME",
        help=f"only this manoeuvre (repeatable); default: {', '.join(COMPARED)}",
    )
    parser.add_argument("--build", choices=BUILDS, help=BUILD_HELP)
    parser.add_argument("--seed", type=int, default=1, help="of the sensor noise (default: %(default)s)")
    parser.add_argument(
        "--output",
        type=Path,
        default=Path("results/compare"),
        metavar="FOLDER",
        help="for tables, figures and the signals of every run (default: %(default)s)",
    )


def run(args: argparse.Namespace) -> int:
    plants = args.plant or PLANTS
    builds = {plant: args.build or chosen_build(plant) for plant in plants}
    manoeuvres = args.manoeuvre or COMPARED
    for name in manoeuvres:
        if name not in MANOEUVRES:
            raise DrivelineError(f"unknown manoeuvre {name}; {nearest(name, MANOEUVRES)}")
    todo = cases(plants, manoeuvres)
    console = wide_console()
    outcomes = list(
        track(
            run_cases(todo, args.seed, args.output / "runs", build=args.build),
            description="simulating",
            total=len(todo),
            console=console,
            transient=True,
            disable=not console.is_terminal,
        )
    )
    console.print(runs_table([outcome.row for outcome in outcomes]))
    console.print(f"FMUs:    {', '.join(f'{Path(plant).stem} {build}' for plant, build in builds.items())}")
    tables = write_tables(outcomes, args.output)
    figures = write_figures(outcomes, args.output)
    console.print(f"tables:  {' '.join(str(path) for path in tables)}", soft_wrap=True)
    for figure in figures:
        if figure.suffix == ".png":
            console.print(f"figure:  {figure} (and .pdf)", soft_wrap=True)
    console.print(f"signals: {args.output / 'runs'}/*.csv ({len(outcomes)} runs)", soft_wrap=True)
    return 0
