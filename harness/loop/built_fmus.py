"""The FMUs that a command or a notebook runs: those of the project are built where they are missing or stale."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from shlex import quote
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from ...fmus.errors import BuildError
from ..base.collected_warnings import warn_once
from ..base.errors import DrivelineError
from .places import BUILD, BUILDS, COMPARATORS, NATIVE, NameOrFile, chosen_build, loop
from .stale_fmus import warn_of_stale

if TYPE_CHECKING:
    from ...fmus.fmu import Fmu


def built(plant: NameOrFile | None = None, folder: Path = BUILD, build: str | None = None, **others: Any) -> str:
    """The build that runs with that plant and the other blocks, which is the one asked for if there is one.

    The project's own FMUs in BUILD are built where they are missing or stale; others are said to be stale.

    Args:
        plant, others: what stands in the places of the loop, see `harness.loop.places.loop`.

    Raises:
        WiringError: there is no such block.
        DrivelineError: FMUs are missing, and says which command makes them; or cannot be built.
    """
    if folder == BUILD:
        build = _refreshed(plant, build, **others)
    build = build or chosen_build(plant, folder, **others)
    system = loop(plant, folder, build, **others)
    missing = [path for name, path in system.instances.items() if name in system.own and not path.is_file()]
    if missing:
        where = "" if folder == BUILD else f" --output {quote(str(folder))}"
        only = f" --build {NATIVE}" if build == NATIVE else ""
        name = f" {missing[0].stem}" if missing[0].stem in COMPARATORS else ""
        raise DrivelineError(f"there is no FMU {missing[0]}; `driveline build{name}{only}{where}` makes it")
    warn_of_stale(system)
    return build


def _refreshed(plant: NameOrFile | None, build: str | None, **others: Any) -> str | None:
    """Builds what is missing or stale in BUILD for a loop; the build that runs, None for that of `chosen_build`."""
    from ...fmus.building.builds import NotPossible, refreshed

    system = loop(plant, BUILD, build or NATIVE, **others)
    names = [path.stem for name, path in system.instances.items() if name in system.own]
    try:
        made = refreshed(names, BUILD, build or NATIVE)
    except NotPossible as reason:
        if build is not None:
            raise DrivelineError(str(reason)) from reason
        warn_once(f"no native FMUs: {reason}")
        return _refreshed(plant, BUILDS[0], **others)
    except BuildError as reason:
        raise DrivelineError(str(reason)) from reason
    if made:
        warn_once(f"built, as missing or stale: {', '.join(map(str, made))}")
    return build


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
