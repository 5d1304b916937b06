"""Drives the car with a pseudo-random binary torque demand, on a road on which it about keeps its speed, and writes
what its sensors record every 2 ms to PLANT_prbs_off.csv in the output folder.

  motor speed      of the resolver, with its noise and resolution
  motor torque     as motor control estimates it
  torque demand    that motor control receives, held until the next sample
  wheel speed      mean of the driven wheels over CAN: coarse, late, held, with validity and counter
  wheel torque     of measurement wheels at both driven wheels, positive when it drives

Errors of the other sensors are parameters of motor and can. The demand repeats after 2^order - 1 clocks.

examples:
  driveline record --plant ValidationVehicle --seed 7
  driveline record --amplitude 15 --clock 0.06 --order 7 --mean 5 --speed 30 --duration 30
  driveline record --noise 0 --offset 0 --gain-error 0 --set motor.sigma_T=0 --set motor.g_T=1.03
"""

from argparse import ArgumentTypeError
from collections.abc import Callable
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Any

from toolground.argument_types import amount, counted, finite, seconds
from toolground.arguments import option, record
from toolground.plain_text import quoted
from toolground.printing import Printing

from ..loop import roles
from ..manoeuvres.prbs import FEEDBACK, TEST_DRIVE, TEST_SPEED
from .options import output
from .settings import resolved as resolved_of
from .signals_run import OneRun, control, signals_job, write_frames


def _gain_error(text: str) -> float:
    """As the estimate of the motor torque can have it, see `g_T`."""
    number = finite(text)
    if not -0.5 <= number <= 1.0:
        raise ArgumentTypeError(f"{quoted(text)} is not a share from -0.5 to 1")
    return number


def _demand(name: str, parse: Callable[[str], Any], metavar: str | None, help: str) -> Any:
    help, default = f"{help} (default: %(default)g)", TEST_DRIVE.get(name, TEST_SPEED)
    return option(default, help, parse, group="torque demand", metavar=metavar)


wheels = partial(option, group="measurement wheels, both together")


@record
class Arguments(OneRun, Printing):
    control: str = control("off")
    output: Path = output("results/record", "the recording")
    amplitude: float = _demand("amplitude", amount, "N.m", "about the mean")
    mean: float = _demand("mean", finite, "N.m", "of the demand")
    clock: float = _demand("clock", seconds, "SECONDS", "shortest pulse")
    order: int = _demand("order", counted(min(FEEDBACK), max(FEEDBACK)), None, "of the shift register")
    speed: float = _demand("speed", amount, "km/h", "of the car")
    duration: float = _demand("duration", seconds, "SECONDS", "of the drive")
    noise: float = wheels(10.0, "rms (default: %(default)g)", amount, metavar="N.m")
    offset: float = wheels(8.0, "(default: %(default)g)", finite, metavar="N.m")
    gain_error: float = wheels(0.01, "(default: %(default)g)", _gain_error, metavar="SHARE")


def run(args: Arguments) -> int:
    resolved = resolved_of(args, args.plant, args.controller, control=args.control == "on")
    given = resolved.settings
    # here and not above: mistakes and help are answered without them
    from ..simulation.excitation_drive import MeasurementWheels, planned, sensed
    from ..simulation.simulate import simulate
    from ..views.signals_file import write_signals

    demand = {name: getattr(args, name) for name in ("mean", "amplitude", "clock", "order", "duration")}
    drive = planned(resolved, demand, args.speed / 3.6)
    wheels = MeasurementWheels(args.noise, args.offset, args.gain_error)
    same = {"demand": demand | {"speed": args.speed, "slope": drive.slope}, "measurement_wheels": asdict(wheels)}
    with signals_job(args, resolved, drive.manoeuvre, same) as (made, stem):
        args.say(
            f"{drive.manoeuvre.description}, {args.duration:g} s on {given.plant_name}, {given.build} FMUs, "
            f"damping {args.control}, slope {100.0 * drive.slope:.2f} %"
        )
        results = simulate(drive.manoeuvre, resolved)
        made.begin()
        made.found({given.plant_name: results})
        recorded = sensed(results, drive.load.i, wheels, given.seed)
        made.wrote(write_signals(recorded, stem, args.format))
        if args.frames:
            made.wrote(*write_frames(resolved, results, stem, args.frames))
        v, T_gear = 3.6 * results[roles.BODY_SPEED], abs(results[roles.GEAR_TORQUE]).max()
        args.say(f"speed {v.min():.1f} to {v.max():.1f} km/h, gear torque up to {T_gear:.0f} N.m")
    return 0
