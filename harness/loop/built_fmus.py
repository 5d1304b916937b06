"""The FMUs that a command or a notebook runs: those of the project are built where they are missing or stale."""

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Unpack

from fmublocks.errors import BuildError, NotPossible
from fmublocks.origin import located, origin_of
from fmuloop.system import System
from toolground.collected_warnings import warn_once
from toolground.errors import UserError

from ...fmus.origin import is_stale
from .mapped_names import require_known
from .places import BUILD, BUILDS, COMPARATORS, NATIVE, NameOrFile
from .settings import Changes, Settings, chosen_build, loop, settings

if TYPE_CHECKING:
    from fmublocks.fmu import Fmu


def built(given: Settings | NameOrFile | None = None, **changes: Unpack[Changes]) -> Settings:
    """The settings with the build and the folder that run, which are those asked for if there is a build; arguments as
    of `harness.loop.settings.settings`.

    Where some of the project's own FMUs in BUILD are missing or stale, those that are needed are built in the user's
    cache, which is the folder then; in other folders they are said to be stale.

    Raises:
        WiringError: there is no such block.
        UserError: FMUs are missing, and says which command makes them; or cannot be built.
    """
    return built_together([settings(given, **changes)])[0]


def built_together(loops: Iterable[Settings], alike: bool = True) -> list[Settings]:
    """What `built` makes of each of several loops that are given the same folder; their FMUs are in one folder then.
    The errors are those of `built`.

    Args:
        alike: they are of one build too, where none is asked for.
    """
    return _checked(list(loops), _in_cache, alike)


def _checked(loops: list[Settings], build_in: "Place", alike: bool = True) -> list[Settings]:
    if loops[0].folder == BUILD:
        loops = _refreshed(loops, build_in)
    found = [chosen_build(made) for made in loops]
    if alike and BUILDS[0] in found:
        found = [BUILDS[0]] * len(found)
    loops = [made.replace(build=made.build or build) for made, build in zip(loops, found, strict=True)]
    for made in loops:
        require_there(made)
    return loops


def require_there(made: Settings) -> System:
    """The loop; warns of what is stale.

    Raises:
        UserError: an FMU of the project is not in the folder; says what makes it there.
        WiringError: the mapping names what is nothing in the loop.
    """
    require_known(made.mapping)
    system = loop(made)
    missing = [path for name, path in system.instances.items() if name in system.own and not path.is_file()]
    if missing:
        where = "" if made.folder == BUILD else f" --output {quote(str(made.folder))}"
        only = f" --build {NATIVE}" if made.build == NATIVE else ""
        name = f" {missing[0].stem}" if missing[0].stem in COMPARATORS else ""
        what, it = (f"there is no FMU {missing[0]}", "it")
        if len(missing) == len(system.own) > 1:
            what, it = f"{missing[0].parent} has none of the FMUs {', '.join(path.stem for path in missing)}", "them"
        raise UserError(f"{what}; `driveline build{name}{only}{where}` makes {it}")
    warn_of_stale(system)
    return system


def warn_of_stale(system: System) -> None:
    """Names, once, the FMUs of a system that were not made from the sources that are installed.

    Those of the project tell what made them. Of the others, and of ours that somebody gives by their path, only those
    that tell it are judged.
    """
    own = system.own
    found = [path for name, path in system.instances.items() if path.is_file() and (name in own or origin_of(path))]
    if found := [path for path in found if is_stale(path)]:
        warn_once(f"stale, not made from the sources that are installed: {', '.join(map(str, found))}")


Needed = Mapping[str, Collection[str]]
"""Names of FMUs by the build that is needed of them."""

Place = Callable[[Needed], tuple[Path, list[Path]]]
"""Builds FMUs that are missing or stale in BUILD; gives the folder that has them all, and what was built."""


def _in_cache(needed: Needed) -> tuple[Path, list[Path]]:
    if not any(is_stale(located(name, BUILD, build)) for build, names in needed.items() for name in names):
        return BUILD, []
    from ...fmus.catalogue import EVERY  # what is up to date is found to be so without
    from .fmu_cache import refreshed_copy

    found = [refreshed_copy([EVERY[name] for name in names], BUILD, build) for build, names in needed.items()]
    return found[0][0], [path for _, new in found for path in new]


def _in_place(needed: Needed) -> tuple[Path, list[Path]]:
    from ...fmus.building.builds import refreshed

    return BUILD, [path for build, names in needed.items() for path in refreshed(list(names), BUILD, build)]


def _refreshed(loops: list[Settings], build_in: Place) -> list[Settings]:
    """Builds what is missing or stale in BUILD for loops; with another build where the native one is not possible."""
    try:
        folder, new = build_in(_needed(loops))
    except NotPossible as reason:
        if all(made.build is not None for made in loops):
            raise UserError(str(reason)) from reason
        warn_once(f"no native FMUs: {reason}")
        return _refreshed([made.replace(build=made.build or BUILDS[0]) for made in loops], build_in)
    except BuildError as reason:
        raise UserError(str(reason)) from reason
    _say(new)
    return [made.replace(folder=folder) for made in loops]


def _needed(loops: Iterable[Settings]) -> Needed:
    needed: dict[str, dict[str, None]] = {}
    for made in loops:
        build = made.build or NATIVE
        for control in (made.control, False):
            system = loop(made, build=build, control=control)
            own = (path.stem for name, path in system.instances.items() if name in system.own)
            needed.setdefault(build, {}).update(dict.fromkeys(own))
    return needed


def _say(new: Sequence[Path]) -> None:
    if new:
        warn_once(f"built, as missing or stale: {', '.join(path.stem for path in new)}, in {new[0].parent}")


def made_if_missing(fmu: "Fmu", folder: Path, build: str) -> Path:
    """An FMU that is no part of the loop: that of the folder, or where it is missing or stale one in the user's cache.

    Raises:
        UserError: it cannot be built here.
    """
    from .fmu_cache import refreshed_copy

    if not is_stale(path := located(fmu.name, folder, build)):
        return path
    try:
        kept, new = refreshed_copy([fmu], folder, build)
    except BuildError as reason:
        raise UserError(str(reason)) from reason
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
        UserError: FMUs are missing, and says which command makes them; or cannot be built.
    """
    return _checked([settings(given, **changes)], _in_place)[0].build or NATIVE
