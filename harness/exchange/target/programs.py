"""The controller as three programs: on the emulated target, and on this machine in single and double precision."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

from ....fmus.native.compiler import CompilerError
from ....fmus.target.image import host_program, target_image
from ....fmus.target.link import Link, TargetError, emulated
from ...base.errors import DrivelineError, SimulationError
from .c_export import with_values


class Programs(NamedTuple):
    """Each starts its program anew, and is called within `with`.

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
def programs(controller: str, values: Mapping[str, Any]) -> Iterator[Programs]:
    """Compiles them with these values of the parameters, by name; they are there as long as this lasts.

    Raises:
        DrivelineError: a compiler or the emulator is missing.
        SimulationError: within it, the target was lost, hung or crashed.
    """
    single, double = (with_values(controller, precision, values) for precision in ("float", "double"))
    with TemporaryDirectory(prefix="driveline-") as temporary:
        folder = Path(temporary)
        try:
            image = target_image(single, folder / "target")
            on_target = emulated(image)
            host = {name: [str(host_program(c, folder / name))] for name, c in (("f", single), ("d", double))}
        except CompilerError as reason:
            raise DrivelineError(str(reason)) from reason
        label = f"{controller} on the emulated target"
        try:
            yield Programs(
                target=lambda: Link(on_target, label),
                single=lambda: Link(host["f"], f"{controller} in single precision"),
                double=lambda: Link(host["d"], f"{controller} in double precision", "d"),
                image=image,
                name=next(Path(name).stem for name in single if name.endswith(".c")),
            )
        except TargetError as reason:
            raise SimulationError(str(reason)) from reason
