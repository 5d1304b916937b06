"""The FMU of a controller that runs on the emulated target."""

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from ..fmu import Fmu
from ..native.statements import SINGLE
from ..python.packaging import build
from .image import target_image
from .sources import target_sources


def build_on_target(fmu: Fmu, folder: Path) -> Path:
    """Builds `folder/<name>.fmu` with the image in it, replacing one that is there, and returns its path.

    The host needs the emulator and, as for every FMU that runs Python, Python 3.11 or later in its process.

    Raises:
        CompilerError: the compiler or the emulator is missing.
    """
    with TemporaryDirectory(prefix="driveline-") as temporary:
        image = target_image(target_sources(fmu, SINGLE), Path(temporary)).read_bytes()
    return build(replace(fmu, image=image), folder)
