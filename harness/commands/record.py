"""Drives the car with a pseudo-random binary torque demand, on a road on which it about keeps its speed, and
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

examples:
  driveline record
  driveline record --plant ValidationVehicle --seed 7
  driveline record --amplitude 15 --clock 0.06 --order 7 --mean 5 --speed 30 --duration 30
  driveline record --control on --output results/closed
  driveline record --noise 0 --offset 0 --gain-error 0 --set motor.sigma_T=0 --set motor.g_T=1.03
  driveline record --vehicle examples/cars/van.toml
  driveline record --format mf4

orders: {orders}; the demand repeats after 2^order - 1 clocks
"""

import argparse
from dataclasses import asdict

from ..base.plain_text import quoted
from ..manoeuvres.prbs import FEEDBACK, TEST_DRIVE, TEST_SPEED
from .frames import add_frames
from .options import add_format, add_loop, add_output, add_plant, add_printing, amount, count, finite, seconds
from .settings import settings
from .signals_run import signals_job, write_run

IN_HELP = {"orders": ", ".join(map(str, FEEDBACK))}


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
    wheels.add_argument("--gain-error", type=_gain_error, default=0.01, metavar="SHARE", help="(default: %(default)g)")
    add_loop(parser)
    add_output(parser, "results/record", "the recording", of_a_run=True)
    add_format(parser)
    add_frames(parser)
    add_printing(parser)


def _order(text: str) -> int:
    return count(text, min(FEEDBACK), max(FEEDBACK))


def _gain_error(text: str) -> float:
    """As the estimate of the motor torque can have it, see `g_T`."""
    number = finite(text)
    if not -0.5 <= number <= 1.0:
        raise argparse.ArgumentTypeError(f"{quoted(text)} is not a share from -0.5 to 1")
    return number


def run(args: argparse.Namespace) -> int:
    given = settings(args, args.plant).replace(control=args.control == "on")
    # here and not above: mistakes and help are answered without them
    from ..simulation.excitation_drive import MeasurementWheels, planned, sensed
    from ..simulation.simulate import simulate

    demand = {name: getattr(args, name) for name in ("mean", "amplitude", "clock", "order", "duration")}
    drive = planned(given, demand, args.speed / 3.6)
    wheels = MeasurementWheels(args.noise, args.offset, args.gain_error)
    same = {"demand": demand | {"speed": args.speed, "slope": drive.slope}, "measurement_wheels": asdict(wheels)}
    with signals_job(args, given, drive.manoeuvre, same) as made:
        made.out.say(
            f"{drive.manoeuvre.description}, {args.duration:g} s on {given.plant_name}, {given.build} FMUs, "
            f"damping {args.control}, slope {100.0 * drive.slope:.2f} %"
        )
        results = simulate(drive.manoeuvre, given)
        made.begin()
        recorded = sensed(results, drive.load.i, wheels, given.seed)
        write_run(args, made, given, drive.manoeuvre, results, recorded)
        v, T_gear = 3.6 * results["plant.v"], abs(results["plant.T_gear"]).max()
        made.out.say(f"speed {v.min():.1f} to {v.max():.1f} km/h, gear torque up to {T_gear:.0f} N.m")
    return 0
