"""The controller on the processor that it is meant for, in C (docs/target.md).

examples:
  driveline target export --vehicle car.toml --parameters gains.toml   its C, in single precision
  driveline target build                                               its FMU, whose step runs on the target
  driveline target image                                               the image, and its A2L description
  driveline target record                                              that C on an emulated Cortex-M4F
  driveline target ACTION --help                                       explains an action
"""

from pathlib import Path

from toolground.argument_types import output_folder
from toolground.arguments import option, record
from toolground.errors import UserError
from toolground.known_names import nearest
from toolground.printing import Printing

from ..loop.places import PLACES
from .jobs import distinguishing, job
from .options import Loop, OurController, Replacing, controller, output, plant
from .settings import resolved as resolved_of


@record
class Export(OurController, Replacing, Printing):
    """Writes the C of a controller: NAME.h and NAME.c, the structs and the arithmetic of its FMU in C99 without
    any FMI, and controller.h, the same under names that do not tell which controller it is.

    The values of the vehicle file and of the gains become its parameters. docs/target.md says how a project calls it.

    examples:
      driveline target export --vehicle car.toml --parameters gains.toml --output car/controller
      driveline target export --controller SpeedWashout --precision double --output build/double
    """

    precision: str = option("float", "of the arithmetic (default: %(default)s)", choices=("float", "double"))
    output: Path = output("build/target", "the C files")


def export(args: Export) -> int:
    # here and not above: mistakes and help are answered without them
    from fmublocks.target.sources import PRECISIONS, target_sources
    from toolground.atomic_files import write_texts

    from ..exchange.target.controllers import for_car
    from ..simulation.provenance import require_same_text

    fmu = for_car(args.controller, args.vehicle, args.parameters)
    sources = target_sources(fmu, PRECISIONS[args.precision])
    files = {args.output / name: text for name, text in sources.items()}
    if folder := next((path for path in files if path.is_dir()), None):
        raise UserError(f"{folder} is a folder; a file is needed")
    if not args.replace:
        for path, text in files.items():
            require_same_text(text, path)
    write_texts(files)
    args.written(files)
    return 0


@record
class Build(OurController, Printing):
    """Builds the FMU of a controller whose start, step and outputs are computed by its C on an emulated Cortex-M4F
    (QEMU, machine mps2-an386), which starts with the run and ends with it. It has the variables of the ordinary one and
    stands in its place, in `driveline simulate --controller` and in any other host: the rest of the loop is unchanged.

    A target that is lost, hangs or crashes is an error that names it, within a second. It needs
    `apt-get install gcc-arm-none-eabi libnewlib-arm-none-eabi qemu-system-arm`; to run, the last alone.

    examples:
      driveline target build --vehicle car.toml --parameters gains.toml --output car/on_target
      driveline simulate --controller build/on_target/DampingController.fmu --manoeuvre launch --plot
    """

    output: Path = option(Path("build/on_target"), "(default: %(default)s)", output_folder, metavar="FOLDER")


def build(args: Build) -> int:
    from fmublocks.target.image import build_on_target

    from ..exchange.target.controllers import for_car

    path = build_on_target(for_car(args.controller, args.vehicle, args.parameters), args.output)
    args.say(f"{path}  {path.stat().st_size / 1024:.0f} kB")
    return 0


@record
class Image(OurController, Printing):
    """Compiles the image with a controller behind a link for the emulated Cortex-M4F, controller.elf, and describes it
    for calibration tools in controller.a2l (ASAM MCD-2 MC): parameters, inputs and outputs with units, limits,
    meanings, and their addresses in that image. The parameters lie in one record in RAM, `calibration`, and what is
    written there acts from the next sample on.

    It needs `apt-get install gcc-arm-none-eabi libnewlib-arm-none-eabi qemu-system-arm`.

    examples:
      driveline target image --vehicle car.toml --parameters gains.toml --output car/image
    """

    output: Path = output("build/image", "the image and its description")


def image(args: Image) -> int:
    from ..exchange.target.controllers import for_car, write_image

    args.written(write_image(for_car(args.controller, args.vehicle, args.parameters), args.output))
    return 0


@record
class Record(Loop, Replacing, Printing):
    """Runs the C of a controller on an emulated Cortex-M4F (QEMU, machine mps2-an386) and compares every sample with
    the same C on this machine: in single precision bit by bit, and in double precision. The exit code is 1 if a bit
    differs, or the torque of a manoeuvre is further from double precision than allowed.

    It is fed with what the controller gets in the loop in every manoeuvre and on a recorded drive, with random inputs,
    absurd ones (NaN, infinities, denormal numbers) and random states. Instructions are counted by the emulator. Then it
    drives every manoeuvre in the loop, see `driveline target build`.

    The output folder gets numbers.json and, for every case, inputs and torques as CSV. It needs
    `apt-get install gcc-arm-none-eabi libnewlib-arm-none-eabi qemu-system-arm`.

    examples:
      driveline target record --controller SpeedWashout --output results/washout
      driveline target record --vehicle car.toml --parameters gains.toml --plant ValidationVehicle
      driveline target record --set controller.k_d=2 --replace
    """

    plant: str = plant()
    controller: str = controller()
    output: Path = output("results/target", "the numbers and the recorded cases")


def run_record(args: Record) -> int:
    if args.controller not in PLACES["controller"]:
        raise UserError(f"there is no C of {args.controller}; {nearest(args.controller, PLACES['controller'])}")
    given = resolved_of(args, args.plant, args.controller)
    # here and not above: mistakes and help are answered without them
    from ..exchange.target.record import NUMBERS, announce, record, write

    plant, numbers = given.settings.plant_name, args.output / NUMBERS
    with job(args, args.output / "target.json", distinguishing(given), {plant: given.fit}, [numbers]) as made:
        found = record(given)
        made.begin()
        made.wrote(*write(found, args.output))
        made.tell(announce, found)
    return int(not found.passed)


ACTIONS = {
    "export": (Export, export, "write the C of a controller"),
    "build": (Build, build, "build the FMU of a controller that runs on an emulated Cortex-M4F"),
    "image": (Image, image, "compile its image for that target, and describe it for calibration tools (A2L)"),
    "record": (Record, run_record, "run it on an emulated Cortex-M4F, off-line, and compare"),
}
"""Each with its arguments, what runs it, and what it does."""
