"""`driveline simulate`: one manoeuvre, one plant, damping on or off."""

import argparse
from pathlib import Path
from time import perf_counter

from ..cosimulation.master import Scheme
from ..cosimulation.system import BUILD_HELP, BUILDS, PLANTS, chosen_build
from ..errors import DrivelineError
from ..manoeuvres.catalogue import MANOEUVRES
from ..names import nearest
from ..reports.csv_file import write_csv
from ..reports.figures import METADATA
from ..reports.run_figure import plot_run
from ..simulate import simulate

NAME = "simulate"
HELP = "drive the loop through one manoeuvre and write its signals"

DESCRIPTION = """\
Runs the closed loop of controller, motor, plant and CAN bus through one manoeuvre and writes every
output of every FMU as CSV, with columns `instance.variable`.

The instances are controller, motor, plant and can. Another vehicle model takes the place of the plant
by one word: the path of an FMU with the same inputs, outputs and the parameters v_0 and T_0.
"""

EXAMPLES = """\
examples:
  driveline simulate --manoeuvre tipin15
  driveline simulate --plant ValidationVehicle --control off --manoeuvre launch
  driveline simulate --plant my_vehicle.fmu --output results/mine.csv
  driveline simulate --set plant.J_1=0.06 --set motor.g_T=1.05 --seed 7
  driveline simulate --step 0.0005 --scheme jacobi
  driveline simulate --manoeuvre launch --plot results/launch.png

manoeuvres:
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    width = max(map(len, MANOEUVRES))
    listed = (f"  {m.name:{width}}  {m.description} ({m.duration:g} s)" for m in MANOEUVRES.values())
    parser.epilog = EXAMPLES + "\n".join(listed)
    parser.add_argument(
        "--plant",
        default=PLANTS[0],
        metavar="NAME|FILE",
        help=f"{' or '.join(PLANTS)}, or an FMU with the same interface (default: %(default)s)",
    )
    parser.add_argument(
        "--manoeuvre", default="tipin15", metavar="NAME", help="one of those below (default: %(default)s)"
    )
    parser.add_argument("--control", choices=("on", "off"), default="on", help="active damping (default: %(default)s)")
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        type=assignment,
        dest="parameters",
        metavar="INSTANCE.PARAMETER=VALUE",
        help="sets a parameter, in SI units (repeatable)",
    )
    parser.add_argument("--build", choices=BUILDS, help=BUILD_HELP)
    parser.add_argument("--seed", type=int, default=1, help="of the sensor noise (default: %(default)s)")
    parser.add_argument(
        "--step",
        type=float,
        default=1e-3,
        metavar="SECONDS",
        help="communication step (default: %(default)s)",
    )
    parser.add_argument(
        "--scheme",
        choices=[scheme.value for scheme in Scheme],
        default=Scheme.GAUSS_SEIDEL.value,
        help="one FMU after the other, or all with the outputs of the beginning of the step (default: %(default)s)",
    )
    parser.add_argument(
        "--output",
        type=Path,
        metavar="FILE.csv",
        help="for the signals (default: results/PLANT_MANOEUVRE_CONTROL.csv)",
    )
    parser.add_argument(
        "--plot",
        type=figure_file,
        metavar="FILE.png",
        help="draws speeds, torques and the motion of the body (.png or .pdf)",
    )


def assignment(text: str) -> tuple[str, float]:
    """`instance.parameter` and value of `instance.parameter=value`; true and false are 1 and 0."""
    name, equals, value = text.partition("=")
    instance, dot, parameter = name.strip().partition(".")
    try:
        number = {"true": 1.0, "false": 0.0}.get(value.strip().lower()) if equals else None
        number = float(value) if number is None else number
    except ValueError:
        number = None
    if not (instance and dot and parameter) or number is None:
        raise argparse.ArgumentTypeError(f"{text!r} is not of the form plant.J_1=0.06")
    return f"{instance}.{parameter}", number


def figure_file(text: str) -> Path:
    """The path of a figure.

    Raises:
        argparse.ArgumentTypeError: its ending is not that of a figure we write.
    """
    path = Path(text)
    if path.suffix not in METADATA:
        raise argparse.ArgumentTypeError(f"{text!r} does not end in {' or '.join(METADATA)}")
    return path


def run(args: argparse.Namespace) -> int:
    if args.manoeuvre not in MANOEUVRES:
        raise DrivelineError(f"unknown manoeuvre {args.manoeuvre}; {nearest(args.manoeuvre, MANOEUVRES)}")
    manoeuvre = MANOEUVRES[args.manoeuvre]
    build = args.build or chosen_build(args.plant)
    plant = Path(args.plant).stem
    began = perf_counter()
    results = simulate(
        manoeuvre,
        plant=args.plant,
        control=args.control == "on",
        parameters=dict(args.parameters),
        step_size=args.step,
        scheme=Scheme(args.scheme),
        seed=args.seed,
        build=build,
    )
    took = perf_counter() - began
    output = args.output or Path("results") / f"{plant}_{manoeuvre.name}_{args.control}.csv"
    write_csv(results, output)
    print(
        f"{manoeuvre.name} on {plant}, {build} FMUs, damping {args.control}: {manoeuvre.duration:g} s in {took:.2f} s\n"
        f"signals: {output} ({len(results)} instants, {len(results.dtype.names or ())} columns)"
    )
    if args.plot:
        plot_run(results, f"{plant}, {manoeuvre.description}, damping {args.control}", args.plot)
        print(f"figure:  {args.plot}")
    return 0
