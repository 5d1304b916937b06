"""`driveline target record`: the controller's C on the emulated target, off-line, beside the same on this machine."""

import argparse
from pathlib import Path
from typing import Any

from ..base.errors import DrivelineError
from ..base.known_names import nearest
from ..loop.built_fmus import built
from .options import add_loop, add_output, add_plant, add_printing
from .printing import Printer
from .settings import blocks, distinguishing, settings

DESCRIPTION = """\
Runs the C of a controller on an emulated Cortex-M4F (QEMU, machine mps2-an386) and compares every sample with the
same C on this machine: in single precision bit by bit, and in double precision. It is fed with what the
controller gets in the loop in every manoeuvre and on a recorded drive, with random inputs, absurd ones (NaN,
infinities, denormal numbers) and random states. Instructions are counted by the emulator. Then it drives every
manoeuvre in the loop, see `driveline target build`.

The output folder gets the page target.md, the figure and, for every case, inputs and torques as CSV. It needs
`apt-get install gcc-arm-none-eabi libnewlib-arm-none-eabi qemu-system-arm cppcheck`.
"""

EXAMPLES = """\
examples:
  driveline target record
  driveline target record --controller SpeedWashout --output results/washout
  driveline target record --vehicle car.toml --parameters gains.toml --plant ValidationVehicle
  driveline target record --set controller.k_d=2 --replace

exit code: 1 if a bit differs, or the torque of a manoeuvre is further from double precision than allowed
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_plant(parser)
    add_loop(parser)
    add_output(parser, "results/target", "the page, the figure and the recorded cases", of_a_run=True)
    add_printing(parser)


def run(args: argparse.Namespace) -> int:
    from ..loop.places import PLACES

    if args.controller not in PLACES["controller"]:
        raise DrivelineError(f"there is no C of {args.controller}; {nearest(args.controller, PLACES['controller'])}")
    build = built(args.plant, args.fmus, args.build, **blocks(args))
    # here and not above: mistakes and help are answered without them
    from ..exchange.target.offline_test import record, write
    from ..simulation.provenance import recorded
    from ..simulation.simulate import looped

    out = Printer(args)
    given: dict[str, Any] = settings(args, args.plant, build)
    system, plant = looped(args.plant, given), Path(args.plant).stem
    same = distinguishing(given, system, None)
    read = [args.vehicle, args.parameters]
    with recorded(
        args.output / "target.json", same, {plant: system}, read, [args.output / "target.md"], args.replace
    ) as made:
        found = record(args.controller, system, args.plant, given)
        made.begin()
        made.files += write(found, args.controller, plant, args.output)
    for each in found.comparisons:
        out.say(
            f"{each.case.name}: {len(each.case.inputs)} samples, {each.differing} with a differing bit, T_ref within "
            f"{each.T_ref:.1g} N.m of double precision, at most {each.instructions[1]} instructions"
        )
    for each in found.loops:
        out.say(
            f"{each.manoeuvre} in the loop: {each.differing} samples differ from off-line, T_ref within "
            f"{each.T_ref:.1g} N.m of the loop in double precision"
        )
    for file in (*made.files, args.output / "target.json"):
        out.say(f"written: {file}")
    return int(not found.passed)
