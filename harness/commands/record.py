"""`driveline record`: a test drive under pseudo-random torque, recorded as a real car would."""

import argparse
from dataclasses import asdict
from pathlib import Path

from ..loop.built_fmus import built
from ..loop.places import STEP_SIZE
from ..manoeuvres.prbs import FEEDBACK, TEST_DRIVE, TEST_SPEED, binary_torque
from .frames import add_frames, require_frames, write_frames
from .options import add_format, add_loop, add_output, add_plant, add_printing, amount, count, finite, seconds
from .printing import Printer
from .settings import blocks, distinguishing, other_format, settings

DESCRIPTION = """\
Drives the car with a pseudo-random binary torque demand, on a road on which it about keeps its speed, and
writes what its sensors record every 2 ms to PLANT_prbs_CONTROL.csv in the output folder:

  motor speed      of the resolver, with its noise and resolution
  motor torque     as motor control estimates it
  torque demand    that motor control receives, held until the next sample
  wheel speed      mean of the driven wheels over CAN, as received: coarse, late, held between messages;
                   with its validity, and a counter of the messages
  wheel torque     of measurement wheels at both driven wheels, positive when it drives, with noise,
                   offset and gain error; T_load = -(wheel torque)/i

Columns have their units in brackets, so that other commands read the file (docs/recordings.md). Errors of
the other sensors are parameters of motor and can.
"""

EXAMPLES = f"""\
examples:
  driveline record
  driveline record --plant ValidationVehicle --seed 7
  driveline record --amplitude 15 --clock 0.06 --order 7 --mean 5 --speed 30 --duration 30
  driveline record --control on --output results/closed
  driveline record --noise 0 --offset 0 --gain-error 0 --set motor.sigma_T=0 --set motor.g_T=1.03
  driveline record --vehicle examples/cars/van.toml
  driveline record --format mf4

orders: {", ".join(map(str, FEEDBACK))}; the demand repeats after 2^order - 1 clocks
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_plant(parser)
    parser.add_argument("--control", choices=("on", "off"), default="off", help="active damping (default: %(default)s)")
    torque = parser.add_argument_group("torque demand")
    for name, kind, default, metavar, text in (
        ("amplitude", amount, TEST_DRIVE["amplitude"], "N.m", "about the mean"),
        ("mean", finite, TEST_DRIVE["mean"], "N.m", "of the demand"),
        ("clock", seconds, TEST_DRIVE["clock"], "SECONDS", "shortest pulse"),
        ("order", _order, TEST_DRIVE["order"], None, "of the shift register that makes the pulses"),
        ("speed", amount, TEST_SPEED, "km/h", "of the car"),
        ("duration", seconds, TEST_DRIVE["duration"], "SECONDS", "of the drive"),
    ):
        torque.add_argument(
            f"--{name}", type=kind, default=default, metavar=metavar, help=f"{text} (default: %(default)g)"
        )
    wheels = parser.add_argument_group("measurement wheels, both together")
    wheels.add_argument("--noise", type=amount, default=10.0, metavar="N.m", help="rms (default: %(default)g)")
    wheels.add_argument("--offset", type=finite, default=8.0, metavar="N.m", help="(default: %(default)g)")
    wheels.add_argument("--gain-error", type=finite, default=0.01, metavar="SHARE", help="(default: %(default)g)")
    add_loop(parser)
    add_output(parser, "results/record", "the recording", of_a_run=True)
    add_format(parser)
    add_frames(parser)
    add_printing(parser)


def _order(text: str) -> int:
    return count(text, min(FEEDBACK), max(FEEDBACK))


def run(args: argparse.Namespace) -> int:
    build = built(args.plant, args.fmus, args.build, **blocks(args))
    # here and not above: mistakes and help are answered without them
    from ..cosimulation.experiment import require_steps
    from ..cosimulation.wiring import fit, out_of_bounds, require
    from ..manoeuvres.road_load import RoadLoad, torque_limit
    from ..simulation.excitation_drive import MeasurementWheels, holding_slope, require_demand, require_sensors, sensed
    from ..simulation.provenance import recorded
    from ..simulation.simulate import looped, simulate, start
    from ..views.signals_file import require_format, signals_path, write_signals

    out = Printer(args)
    plant = Path(args.plant).stem
    name = f"{plant}_prbs_{args.control}"
    recording, record = signals_path(args.output / name, args.format), args.output / f"{name}.json"
    require_format(args.format)
    given = settings(args, args.plant, build)
    system = looped(args.plant, given)
    fitted = fit(system)
    require_sensors(fitted.interfaces)
    require_frames(args, system.own)
    require_steps(args.duration, STEP_SIZE)
    require_demand(args.mean, args.amplitude, args.clock, torque_limit(fitted.interfaces["motor"], given["parameters"]))
    load = RoadLoad.of_plant(fitted.interfaces["plant"], given["parameters"])
    v_0 = args.speed / 3.6
    slope = holding_slope(load, args.mean, v_0)
    demand = {name: getattr(args, name) for name in ("mean", "amplitude", "clock", "order", "duration")}
    manoeuvre = binary_torque("prbs", **demand, v_0=v_0, slope=slope)
    require(out_of_bounds(fitted, start(manoeuvre) | given["parameters"]))
    wheels = MeasurementWheels(args.noise, args.offset, args.gain_error)
    same = {"demand": demand | {"speed": args.speed, "slope": slope}, "damping": args.control}
    same |= {"measurement_wheels": asdict(wheels)} | distinguishing(given, system, manoeuvre) | other_format(args)
    with recorded(record, same, {plant: system}, [args.vehicle, args.parameters], [recording], args.replace) as made:
        results = simulate(manoeuvre, plant=args.plant, control=args.control == "on", **given)
        made.begin()
        write_signals(sensed(results, load.i, wheels, given["seed"]), args.output / name, args.format)
        made.files += [recording, *write_frames(args, results, fitted, given["parameters"], args.output / name)]
    out.say(
        f"{manoeuvre.description}, {args.duration:g} s on {plant}, {build} FMUs, damping {args.control}, "
        f"slope {100.0 * slope:.2f} %"
    )
    v = results["plant.v"]
    out.say(
        f"speed {3.6 * v.min():.1f} to {3.6 * v.max():.1f} km/h, gear torque up to "
        f"{abs(results['plant.T_gear']).max():.0f} N.m"
    )
    for file in (*made.files, record):
        out.say(f"written: {file}")
    return 0
