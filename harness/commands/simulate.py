"""Drives one manoeuvre with the loop of controller, motor, plant and CAN bus, prints the metrics of the run and
writes every signal, with columns `instance.variable`, to PLANT_MANOEUVRE_CONTROL.csv in the output folder, or
to Parquet or ASAM MDF 4 (--format).

An FMU of your own takes the place of controller, motor, plant or can by one word, its path; what it calls
otherwise than ours, --map renames.

--manoeuvre also takes {own}.

examples:
  driveline simulate --manoeuvre tipin15
  driveline simulate --list
  driveline simulate --plant ValidationVehicle --control off --manoeuvre launch --plot
  driveline simulate --plant my_vehicle.fmu --output results/mine
  driveline simulate --plant theirs.fmu --map plant.T_gear=Shaft.tau --map plant.omega_1=Motor.n
  driveline simulate --vehicle examples/cars/van.toml --parameters van_gains.toml
  driveline simulate --set plant.J_1=0.06 --set motor.g_T=1.05 --seed 7
  driveline simulate --manoeuvre drive --set controller.k_d@2.0=1.5 --set controller.k_d@5=2.55
  driveline simulate --manoeuvre drive --plot --window 4,6 --figures svg
  driveline simulate --manoeuvre drive --format mf4 --frames blf
  driveline simulate --manoeuvre examples/manoeuvres/overtaking.toml --plot
"""

import argparse
from typing import TYPE_CHECKING

from ..base.errors import DrivelineError
from ..cosimulation.system import Scheme
from ..loop.places import STEP_SIZE
from ..loop.settings import Settings
from ..manoeuvres.manoeuvre import Manoeuvre
from ..views.figure_options import FigureOptions
from .course import RunJob
from .frames import add_frames
from .manoeuvres import OWN, add_manoeuvre, chosen
from .options import (
    add_figures,
    add_format,
    add_loop,
    add_output,
    add_plant,
    add_printing,
    experts,
    figure_options,
    seconds,
)
from .settings import caption, dampings, settings
from .signals_run import signals_job, stem_of, write_run

if TYPE_CHECKING:
    from ..cosimulation.results import Results

IN_HELP = {"own": OWN}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_manoeuvre(parser, "one of --list, or a file (default: %(default)s)", default="tipin15")
    add_plant(parser)
    parser.add_argument("--control", choices=("on", "off"), default="on", help="active damping (default: %(default)s)")
    add_loop(parser)
    experts(parser).add_argument(
        "--step", type=seconds, default=STEP_SIZE, metavar="SECONDS", help="communication step (default: %(default)s)"
    )
    experts(parser).add_argument(
        "--scheme",
        choices=[scheme.value for scheme in Scheme],
        default=Scheme.PROPAGATED.value,
        help="when outputs reach inputs: at their instant, one FMU after the other, or a step later; "
        "docs/coupling.md shows what that does (default: %(default)s)",
    )
    add_output(parser, "results/simulate", "the signals and the figure", of_a_run=True)
    add_format(parser)
    add_frames(parser)
    parser.add_argument("--plot", action="store_true", help="draw speeds, torques and the motion of the body")
    add_figures(parser)
    add_printing(parser, table=True)


def run(args: argparse.Namespace) -> int:
    given = settings(args, args.plant).replace(
        control=args.control == "on", step_size=args.step, scheme=Scheme(args.scheme)
    )
    # here and not above: mistakes and help are answered without them
    from ..cosimulation.experiment import require_steps
    from ..simulation.simulate import simulate

    asked = chosen([args.manoeuvre])
    (manoeuvre,) = asked.manoeuvres.values()
    options = _options_of_figure(args, manoeuvre)
    require_steps(manoeuvre.duration, args.step)
    same = {"manoeuvre": manoeuvre.name, "step_size": args.step, "scheme": args.scheme} | asked.digests
    with signals_job(args, given, manoeuvre, same, asked.files.values()) as made:
        asked.require_drivable(made.fits, {given.plant_name: given})
        made.out.say(f"{manoeuvre.name} on {given.plant_name}, {given.build} FMUs, damping {args.control}")
        results = simulate(manoeuvre, given)
        made.begin()
        write_run(args, made, given, manoeuvre, results, results)
        if args.plot:
            _draw(args, made, given, manoeuvre, results, options)
        _tell(made, given, manoeuvre, results)
    return 0


def _draw(
    args: argparse.Namespace,
    made: RunJob,
    given: Settings,
    manoeuvre: Manoeuvre,
    results: "Results",
    options: FigureOptions,
) -> None:
    from ..views.run_figure import plot_run

    title = f"{given.plant_name}, {manoeuvre.description}, damping {args.control}"
    made.wrote(*plot_run(results, manoeuvre, title, stem_of(args, given, manoeuvre), options))


def _options_of_figure(args: argparse.Namespace, manoeuvre: Manoeuvre) -> FigureOptions:
    """What was asked of the figure.

    Raises:
        DrivelineError: there is none, or it would show nothing.
    """
    if not args.plot and (args.window or args.figures):
        raise DrivelineError(f"{'--window' if args.window else '--figures'} is for the figure; ask for it with --plot")
    return figure_options(args, caption(args), (manoeuvre.name, 0.0, manoeuvre.duration))


def _tell(made: RunJob, given: Settings, manoeuvre: Manoeuvre, results: "Results") -> None:
    """How signals went between the FMUs, and the metrics of the run; with steps that do not fit into the samples of the
    controller why there are none."""
    from ..cosimulation.schedule import described, transfers
    from ..metrics.evaluate import evaluate
    from ..studies.compare.compare import Case, Outcome
    from ..views.terminal import print_runs

    fitted = made.fits[given.plant_name]
    if given.scheme is Scheme.PROPAGATED:
        made.out.say(described(transfers(fitted.system, fitted.interfaces)))
    try:
        metrics = evaluate(results, manoeuvre)
    except ValueError as reason:
        made.tell(print, f"no metrics: {reason}", runs=[])
        return
    outcome = Outcome(Case(str(given.plant), manoeuvre.name, given.control), metrics, results)
    made.tell(print_runs, [outcome.row], dampings(given), runs=[outcome.record])
