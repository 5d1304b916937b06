"""The FMUs that a command or a notebook runs: those of the project are built where they are missing or stale."""

from collections.abc import Callable, Sequence
from pathlib import Path
from shlex import quote
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
    """The settings with the build and the folder that run, which are those asked for if there is a build; arguments as
    of `harness.loop.settings.settings`.

    Where some of the project's own FMUs in BUILD are missing or stale, those that are needed are built in the user's
    cache, which is the folder then; in other folders they are said to be stale.

    Raises:
        WiringError: there is no such block.
        DrivelineError: FMUs are missing, and says which command makes them; or cannot be built.
    """
    return _checked(settings(given, **changes), _in_cache)


def _checked(made: Settings, build_in: "Place") -> Settings:
    if made.folder == BUILD:
        made = _refreshed(made, build_in)
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


Place = Callable[[Sequence[str], str], tuple[Path, list[Path]]]
"""Builds FMUs, by name, that are missing or stale in BUILD; gives the folder that has them all, and what was built."""


def _in_cache(names: Sequence[str], build: str) -> tuple[Path, list[Path]]:
    from ...fmus.building.builds import located
    from ...fmus.origin import is_stale

    if not any(is_stale(located(name, BUILD, build)) for name in names):
        return BUILD, []
    from ...fmus.catalogue import EVERY  # what is up to date is found to be so without
    from .fmu_cache import refreshed_copy

    return refreshed_copy([EVERY[name] for name in names], BUILD, build)


def _in_place(names: Sequence[str], build: str) -> tuple[Path, list[Path]]:
    from ...fmus.building.builds import refreshed

    return BUILD, refreshed(names, BUILD, build)


def _refreshed(made: Settings, build_in: Place) -> Settings:
    """Builds what is missing or stale in BUILD for a loop; with another build where the native one is not possible."""
    from ...fmus.building.builds import NotPossible

    build = made.build or NATIVE
    system = loop(made, build=build)
    names = [path.stem for name, path in system.instances.items() if name in system.own]
    try:
        folder, new = build_in(names, build)
    except NotPossible as reason:
        if made.build is not None:
            raise DrivelineError(str(reason)) from reason
        warn_once(f"no native FMUs: {reason}")
        return _refreshed(made.replace(build=BUILDS[0]), build_in)
    except BuildError as reason:
        raise DrivelineError(str(reason)) from reason
    _say(new)
    return made.replace(folder=folder)


def _say(new: Sequence[Path]) -> None:
    if new:
        warn_once(f"built, as missing or stale: {', '.join(path.stem for path in new)}, in {new[0].parent}")


def made_if_missing(fmu: "Fmu", folder: Path, build: str) -> Path:
    """An FMU that is no part of the loop: that of the folder, or where it is missing or stale one in the user's cache.

    Raises:
        DrivelineError: it cannot be built here.
    """
    from ...fmus.building.builds import located
    from ...fmus.origin import is_stale
    from .fmu_cache import refreshed_copy

    if not is_stale(path := located(fmu.name, folder, build)):
        return path
    try:
        kept, new = refreshed_copy([fmu], folder, build)
    except BuildError as reason:
        raise DrivelineError(str(reason)) from reason
    _say(new)
    return located(fmu.name, kept, build)


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
    return _checked(settings(given, **changes), _in_place).build or NATIVE
