"""Drives one manoeuvre with the loop of controller, motor, plant and CAN bus, prints the metrics of the run and writes
every signal, with columns `instance.variable`, to PLANT_MANOEUVRE_CONTROLLER.csv in the output folder.

An FMU of your own takes the place of controller, motor, plant or can by one word, its path; what it calls otherwise
than ours, --map renames. A manoeuvre of your own is a TOML file or a table over time (docs/manoeuvres.md).

examples:
  driveline simulate --plant ValidationVehicle --control off --manoeuvre launch --plot
  driveline simulate --plant theirs.fmu --map plant.T_gear=Shaft.tau --output results/theirs
  driveline simulate --vehicle examples/cars/van.toml --parameters van_gains.toml
  driveline simulate --manoeuvre drive --set controller.k_d@2.0=1.5 --set motor.g_T=1.05 --seed 7
  driveline simulate --manoeuvre examples/manoeuvres/overtaking.toml --format mf4 --frames blf --figures svg --plot
"""

from pathlib import Path

from fmuloop.system import Scheme
from toolground.argument_types import seconds
from toolground.arguments import expert, option, record
from toolground.errors import UserError
from toolground.printing import JsonPrinting

from ..loop.places import STEP_SIZE
from ..manoeuvres.manoeuvre import Manoeuvre
from ..views.figure_options import FigureOptions
from .manoeuvres import Chosen, Listing, manoeuvre
from .options import DriveUnits, Figures, output
from .settings import caption
from .settings import resolved as resolved_of
from .signals_run import OneRun, signals_job, write_frames


@record
class Arguments(Listing, OneRun, DriveUnits, Figures, JsonPrinting):
    manoeuvre: Chosen = manoeuvre("one of --list, or a file (default: %(default)s)", "tipin15")
    output: Path = output("results/simulate", "the signals and the figure")
    plot: bool = option(False, "draw speeds, torques and the motion of the body")
    step: float = expert(STEP_SIZE, "communication step (default: %(default)s)", seconds, metavar="SECONDS")
    scheme: str = expert(
        Scheme.PROPAGATED.value,
        "when outputs reach inputs: at their instant, one FMU after the other, or a step later (default: %(default)s)",
        choices=[scheme.value for scheme in Scheme],
    )


def run(args: Arguments) -> int:
    options = _options_of_figure(args, args.manoeuvre.first)
    resolved = resolved_of(args, args.plant, args.controller).replace(
        control=args.control == "on", step_size=args.step, scheme=Scheme(args.scheme)
    )
    given, chosen = resolved.settings, args.manoeuvre.with_torque(resolved.T_max)
    manoeuvre = chosen.first
    # here and not above: mistakes and help are answered without them
    from fmuloop.experiment import require_steps
    from fmuloop.schedule import described, transfers

    from ..manoeuvres.drivable import require_possible
    from ..simulation.simulate import simulate
    from ..studies.compare.compare import Case, outcomes_of
    from ..views.signal_lines import WITHOUT
    from ..views.signals_file import write_signals
    from ..views.terminal import print_runs

    require_steps(manoeuvre.duration, args.step)
    same = {"manoeuvre": manoeuvre.name, "step_size": args.step, "scheme": args.scheme} | args.manoeuvre.digests
    with signals_job(args, resolved, manoeuvre, same, args.manoeuvre.files.values()) as (made, stem):
        require_possible(*chosen, [resolved])
        args.say(f"{manoeuvre.name} on {given.plant_name}, {given.build} FMUs, damping {args.control}")
        results = simulate(manoeuvre, resolved)
        made.begin()
        made.found({given.plant_name: results})
        made.wrote(write_signals(results, stem, args.format))
        if args.frames:
            made.wrote(*write_frames(resolved, results, stem, args.frames))
        if args.plot:
            from ..loop.unit_runs import of_unit
            from ..views.run_figure import plot_run

            for unit in given.topology.units:
                title = f"{unit.named(given.plant_name)}, {manoeuvre.description}, damping {args.control}"
                file = stem.with_name("_".join(filter(None, (stem.name, unit.name))))
                made.wrote(*plot_run(of_unit(results, unit), manoeuvre, title, file, options))
        if given.scheme is Scheme.PROPAGATED:
            args.say(described(transfers(resolved.fit.system, resolved.fit.interfaces)))
        controller = given.controller_name if given.control else WITHOUT
        try:
            case = Case(given.plant_name, manoeuvre.name, controller)
            outcomes = outcomes_of(case, manoeuvre, results, given.topology)
        except ValueError as reason:  # the steps do not fit into the samples of the controller
            made.tell(print, f"no metrics: {reason}", runs=[], no_metrics=str(reason))
        else:
            title = f"damping by {controller}" if given.control else WITHOUT
            rows = [outcome.row() for outcome in outcomes]
            made.tell(print_runs, rows, title, runs=[outcome.record for outcome in outcomes])
    return 0


def _options_of_figure(args: Arguments, manoeuvre: Manoeuvre) -> FigureOptions:
    """What was asked of the figure.

    Raises:
        UserError: there is none, or it would show nothing.
    """
    if not args.plot and (args.window or args.figures):
        raise UserError(f"{'--window' if args.window else '--figures'} is for the figure; ask for it with --plot")
    return args.options(caption(args), (manoeuvre.name, 0.0, manoeuvre.duration))
