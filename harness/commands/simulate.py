"""`driveline simulate`: one manoeuvre, one plant, damping on or off."""

import argparse
from pathlib import Path
from time import perf_counter

from ..base.errors import DrivelineError
from ..cosimulation.system import Scheme
from ..loop.built_fmus import built
from ..loop.places import STEP_SIZE
from ..manoeuvres.catalogue import MANOEUVRES
from .frames import add_frames, require_frames, write_frames
from .manoeuvres import OWN, add_manoeuvre, chosen, digests, files, require_files_drivable
from .options import add_figures, add_format, add_loop, add_output, add_plant, add_printing, figure_options, seconds
from .printing import Printer
from .settings import blocks, caption, distinguishing, other_format, settings

DESCRIPTION = """\
Runs the closed loop of controller, motor, plant and CAN bus through one manoeuvre and writes every
output of every FMU, with columns `instance.variable`, to PLANT_MANOEUVRE_CONTROL.csv in the
output folder, or to Parquet or ASAM MDF 4 (--format).

The instances are controller, motor, plant and can. An FMU of your own takes the place of any of them by
one word, its path. The plant has the inputs and outputs of ours and the parameters v_0 and T_0; what an
FMU calls otherwise, --map renames.
"""

WIDTH = max(map(len, MANOEUVRES))

EXAMPLES = """\
examples:
  driveline simulate --manoeuvre tipin15
  driveline simulate --plant ValidationVehicle --control off --manoeuvre launch
  driveline simulate --plant my_vehicle.fmu --output results/mine
  driveline simulate --plant theirs.fmu --map plant.T_gear=Shaft.tau --map plant.omega_1=Motor.n
  driveline simulate --controller my_controller.fmu
  driveline simulate --vehicle examples/cars/van.toml --parameters van_gains.toml
  driveline simulate --set plant.J_1=0.06 --set motor.g_T=1.05 --seed 7
  driveline simulate --step 0.0005 --scheme jacobi
  driveline simulate --manoeuvre launch --plot
  driveline simulate --manoeuvre drive --plot --window 4,6 --figures svg
  driveline simulate --manoeuvre launch --format mf4
  driveline simulate --manoeuvre drive --frames blf
  driveline simulate --manoeuvre examples/manoeuvres/overtaking.toml --plot

manoeuvres:
""" + "\n".join(
    [*(f"  {m.name:{WIDTH}}  {m.description} ({m.duration:g} s)" for m in MANOEUVRES.values()), f"or {OWN}"]
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_manoeuvre(parser, "one of those below, or a file (default: %(default)s)", default="tipin15")
    add_plant(parser)
    parser.add_argument("--control", choices=("on", "off"), default="on", help="active damping (default: %(default)s)")
    add_loop(parser)
    parser.add_argument(
        "--step", type=seconds, default=STEP_SIZE, metavar="SECONDS", help="communication step (default: %(default)s)"
    )
    parser.add_argument(
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
    add_printing(parser)


def run(args: argparse.Namespace) -> int:
    build = built(args.plant, args.fmus, args.build, **blocks(args))
    # here and not above: mistakes and help are answered without them
    from ..cosimulation.experiment import require_steps
    from ..cosimulation.schedule import described, transfers
    from ..simulation.provenance import recorded
    from ..simulation.simulate import looped, simulate
    from ..views.signals_file import require_format, signals_path, write_signals

    out = Printer(args)
    (manoeuvre,) = chosen([args.manoeuvre]).values()
    if not args.plot and (args.window or args.figures):
        raise DrivelineError(f"{'--window' if args.window else '--figures'} is for the figure; ask for it with --plot")
    drawing = figure_options(args, caption(args), (manoeuvre.name, 0.0, manoeuvre.duration))
    require_steps(manoeuvre.duration, args.step)
    plant = Path(args.plant).stem
    name = f"{plant}_{manoeuvre.name}_{args.control}"
    signals, record = signals_path(args.output / name, args.format), args.output / f"{name}.json"
    require_format(args.format)
    given = settings(args, args.plant, build)
    system = looped(args.plant, given)
    require_frames(args, system.own)
    same = {"manoeuvre": manoeuvre.name, "damping": args.control, "step_size": args.step, "scheme": args.scheme}
    same |= distinguishing(given, system, manoeuvre)
    same |= digests([args.manoeuvre]) | other_format(args)
    read = [*files([args.manoeuvre]).values(), args.vehicle, args.parameters]
    with recorded(record, same, {plant: system}, read, [signals], args.replace) as made:
        require_files_drivable([args.manoeuvre], {manoeuvre.name: manoeuvre}, made.fits[plant], given["parameters"])
        began = perf_counter()
        results = simulate(
            manoeuvre,
            plant=args.plant,
            control=args.control == "on",
            step_size=args.step,
            scheme=Scheme(args.scheme),
            **given,
        )
        took = perf_counter() - began
        of_the_run = f"{manoeuvre.name} on {plant}, {build} FMUs, damping {args.control}"
        out.say(f"{of_the_run}: {manoeuvre.duration:g} s in {took:.2f} s")
        if Scheme(args.scheme) is Scheme.PROPAGATED:
            out.say(described(transfers(made.fits[plant].system, made.fits[plant].interfaces)))
        made.begin()
        write_signals(results, args.output / name, args.format)
        made.files.append(signals)
        out.say(f"signals: {signals} ({len(results)} instants, {len(results.dtype.names or ())} columns)")
        for file in write_frames(args, results, made.fits[plant], given["parameters"], args.output / name):
            made.files.append(file)
            out.say(f"bus:     {file}")
        if args.plot:
            from ..views.run_figure import plot_run

            title = f"{plant}, {manoeuvre.description}, damping {args.control}"
            for figure in plot_run(results, manoeuvre, title, args.output / name, drawing):
                made.files.append(figure)
                out.say(f"figure:  {figure}")
    out.say(f"made by: {record} (version, FMUs, parameters, units)")
    return 0
