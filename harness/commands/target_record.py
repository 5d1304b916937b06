"""Runs the C of a controller on an emulated Cortex-M4F (QEMU, machine mps2-an386) and compares every sample with the
same C on this machine: in single precision bit by bit, and in double precision. It is fed with what the
controller gets in the loop in every manoeuvre and on a recorded drive, with random inputs, absurd ones (NaN,
infinities, denormal numbers) and random states. Instructions are counted by the emulator. Then it drives every
manoeuvre in the loop, see `driveline target build`.

The output folder gets numbers.json and, for every case, inputs and torques as CSV. It needs
`apt-get install gcc-arm-none-eabi libnewlib-arm-none-eabi qemu-system-arm cppcheck`.

examples:
  driveline target record
  driveline target record --controller SpeedWashout --output results/washout
  driveline target record --vehicle car.toml --parameters gains.toml --plant ValidationVehicle
  driveline target record --set controller.k_d=2 --replace

exit code: 1 if a bit differs, or the torque of a manoeuvre is further from double precision than allowed
"""

import argparse

from ..base.errors import DrivelineError
from ..base.known_names import nearest
from ..loop.places import PLACES
from .course import job
from .options import add_loop, add_output, add_plant, add_printing
from .settings import distinguishing, settings


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_plant(parser)
    add_loop(parser)
    add_output(parser, "results/target", "the numbers and the recorded cases", of_a_run=True)
    add_printing(parser)


def run(args: argparse.Namespace) -> int:
    if args.controller not in PLACES["controller"]:
        raise DrivelineError(f"there is no C of {args.controller}; {nearest(args.controller, PLACES['controller'])}")
    given = settings(args, args.plant)
    # here and not above: mistakes and help are answered without them
    from ..exchange.target.record import NUMBERS, announce, record, write

    plant = given.plant_name
    with job(args, args.output / "target.json", distinguishing(given), {plant: given}, [args.output / NUMBERS]) as made:
        found = record(given)
        made.begin()
        made.wrote(*write(found, args.output))
        made.tell(announce, found)
    return int(not found.passed)
