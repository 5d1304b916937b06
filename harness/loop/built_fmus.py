"""The FMUs that a command or a notebook runs: those of the project are built where they are missing or stale."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from shlex import quote
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Unpack

from ...fmus.errors import BuildError
from ..base.collected_warnings import warn_once
from ..base.errors import DrivelineError
from .places import BUILD, BUILDS, COMPARATORS, NATIVE, NameOrFile
from .settings import Changes, Settings, chosen_build, loop, settings
from .stale_fmus import warn_of_stale

if TYPE_CHECKING:
    from ...fmus.fmu import Fmu


def built(given: Settings | NameOrFile | None = None, **changes: Unpack[Changes]) -> Settings:
    """The settings with the build that runs, which is the one asked for if there is one; arguments as of
    `harness.loop.settings.settings`.

    The project's own FMUs in BUILD are built where they are missing or stale; others are said to be stale.

    Raises:
        WiringError: there is no such block.
        DrivelineError: FMUs are missing, and says which command makes them; or cannot be built.
    """
    made = settings(given, **changes)
    if made.folder == BUILD:
        made = _refreshed(made)
    made = made.replace(build=made.build or chosen_build(made))
    system = loop(made)
    missing = [path for name, path in system.instances.items() if name in system.own and not path.is_file()]
    if missing:
        where = "" if made.folder == BUILD else f" --output {quote(str(made.folder))}"
        only = f" --build {NATIVE}" if made.build == NATIVE else ""
        name = f" {missing[0].stem}" if missing[0].stem in COMPARATORS else ""
        raise DrivelineError(f"there is no FMU {missing[0]}; `driveline build{name}{only}{where}` makes it")
    warn_of_stale(system)
    return made


def _refreshed(made: Settings) -> Settings:
    """Builds what is missing or stale in BUILD for a loop; with another build where the native one is not possible."""
    from ...fmus.building.builds import NotPossible, refreshed

    build = made.build or NATIVE
    system = loop(made, build=build)
    names = [path.stem for name, path in system.instances.items() if name in system.own]
    try:
        new = refreshed(names, BUILD, build)
    except NotPossible as reason:
        if made.build is not None:
            raise DrivelineError(str(reason)) from reason
        warn_once(f"no native FMUs: {reason}")
        return _refreshed(made.replace(build=BUILDS[0]))
    except BuildError as reason:
        raise DrivelineError(str(reason)) from reason
    if new:
        warn_once(f"built, as missing or stale: {', '.join(map(str, new))}")
    return made


@contextmanager
def made_if_missing(fmu: "Fmu", folder: Path, build: str) -> Iterator[Path]:
    """An FMU that is no part of the loop: that of the folder, or where it is missing or stale one that is built, in a
    folder that is not BUILD for as long as this lasts.

    Raises:
        DrivelineError: it cannot be built here.
    """
    from ...fmus.building.builds import builders
    from ...fmus.origin import is_stale

    path = (folder / NATIVE if build == NATIVE else folder) / f"{fmu.name}.fmu"
    with TemporaryDirectory(prefix="driveline-") as temporary:
        try:
            yield builders(build)[0](fmu, folder if folder == BUILD else Path(temporary)) if is_stale(path) else path
        except BuildError as reason:
            raise DrivelineError(str(reason)) from reason


def build_missing(given: Settings | NameOrFile | None = None, **changes: Unpack[Changes]) -> str:
    """Builds those of the project's FMUs that are missing or stale in the folder `build`, for a loop that is to run.

        driveline.build_missing("ValidationVehicle")  # half a minute the first time, next to nothing afterwards

    Args:
        given, changes: settings or a plant, and what else `simulate` takes. In another folder nothing is built; a
            warning says which FMUs there are stale.

    Returns:
        The build that runs, "native" or "python".

    Raises:
        WiringError: there is no such block.
        DrivelineError: FMUs are missing, and says which command makes them; or cannot be built.
    """
    return built(given, **changes).build or NATIVE
