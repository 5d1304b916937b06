"""The image of a controller for the target, and its FMU with that image, for a car."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from ....fmus.fmu import Fmu
from ...base.atomic_files import complete, write_text
from ...base.errors import DrivelineError
from .c_export import values_of


def built_on_target(controller: str, folder: Path, vehicle: Path | None = None, parameters: Path | None = None) -> Path:
    """Builds it into a folder and returns its path.

    Args:
        controller: a name in `fmus.target.sources.CONTROLLERS`.
        vehicle, parameters: files with values of its parameters.

    Raises:
        DrivelineError: a file is refused, or the compiler or the emulator is missing.
    """
    with _compiling(controller, vehicle, parameters) as fmu:
        from ....fmus.target.fmu import build_on_target

        return build_on_target(fmu, folder)


def write_image(
    controller: str, folder: Path, vehicle: Path | None = None, parameters: Path | None = None
) -> list[Path]:
    """Writes controller.elf and its description controller.a2l into a folder; arguments and errors as above."""
    with _compiling(controller, vehicle, parameters) as fmu, TemporaryDirectory(prefix="driveline-") as temporary:
        from ....fmus.native.statements import SINGLE
        from ....fmus.target.a2l import description
        from ....fmus.target.image import target_image
        from ....fmus.target.sources import target_sources

        image = target_image(target_sources(fmu, SINGLE), Path(temporary))
        files = [folder / image.name, folder / "controller.a2l"]
        with complete(files[0]) as unfinished:
            unfinished.write_bytes(image.read_bytes())
        write_text(description(fmu, image), files[1])
        return files


@contextmanager
def _compiling(controller: str, vehicle: Path | None, parameters: Path | None) -> Iterator[Fmu]:
    """The controller with the values of two files; what the compiler refuses within is an error of the command."""
    values = values_of(controller, vehicle, parameters)
    from ....fmus.native.compiler import CompilerError
    from ....fmus.target.sources import CONTROLLERS

    try:
        yield CONTROLLERS[controller].started_with(values)
    except CompilerError as reason:
        raise DrivelineError(str(reason)) from reason
