"""A controller as a program: for a car, on the target and on this machine."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from fmublocks.fmu import Fmu
from fmublocks.native.statements import DOUBLE, SINGLE
from fmublocks.target.image import a2l_description, host_program, target_image
from fmublocks.target.link import Link, TargetError, emulated
from fmublocks.target.sources import target_sources
from fmuloop.errors import SimulationError
from toolground.atomic_files import complete, write_text

from ....fmus.building.one_car import of_one_car
from ....fmus.building.parameter_files import read_files, require_taken
from ....fmus.catalogue import CONTROLLERS


def for_car(controller: str, vehicle: Path | None = None, parameters: Path | None = None) -> Fmu:
    """A controller with what two files say of its parameters.

    Args:
        controller: a name in `fmus.target.sources.CONTROLLERS`.

    Raises:
        ParameterFileError: a file is refused.
    """
    fmu = CONTROLLERS[controller]
    names = fmu.block.Parameters._fields
    require_taken(parameters, names, controller)
    return fmu.started_with(of_one_car(read_files(vehicle, parameters), names))


def write_image(fmu: Fmu, folder: Path) -> list[Path]:
    """Writes controller.elf and its description controller.a2l into a folder; returns the files.

    Raises:
        CompilerError: the compiler or the emulator is missing.
    """
    with TemporaryDirectory(prefix="driveline-") as temporary:
        image = target_image(target_sources(fmu, SINGLE), Path(temporary))
        files = [folder / image.name, folder / "controller.a2l"]
        with complete(files[0]) as unfinished:
            unfinished.write_bytes(image.read_bytes())
        write_text(a2l_description(fmu, image), files[1])
        return files


class Programs(NamedTuple):
    """A controller as three programs, each of which starts anew when it is called, within `with`.

    Attributes:
        target: the image on the emulated target.
        single, double: the same C on this machine.
        image: file of the image; what was made with it lies beside it.
        name: of the files of the controller among that.
    """

    target: Callable[[], Link]
    single: Callable[[], Link]
    double: Callable[[], Link]
    image: Path
    name: str


@contextmanager
def programs(fmu: Fmu) -> Iterator[Programs]:
    """Compiles them; they are there as long as this lasts.

    Raises:
        CompilerError: a compiler or the emulator is missing.
        SimulationError: within it, the target was lost, hung or crashed.
    """
    single, double = (target_sources(fmu, precision) for precision in (SINGLE, DOUBLE))
    with TemporaryDirectory(prefix="driveline-") as temporary:
        folder = Path(temporary)
        image = target_image(single, folder / "target")
        here = [[str(host_program(c, folder / name))] for name, c in (("single", single), ("double", double))]
        try:
            yield Programs(
                target=lambda: Link(emulated(image), f"{fmu.name} on the emulated target"),
                single=lambda: Link(here[0], f"{fmu.name} in single precision"),
                double=lambda: Link(here[1], f"{fmu.name} in double precision", "d"),
                image=image,
                name=next(Path(name).stem for name in single if name.endswith(".c")),
            )
        except TargetError as reason:
            raise SimulationError(str(reason)) from reason
