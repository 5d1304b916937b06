"""FMUs that are made on the way to a run stand in the user's cache; the folder that the run is given is only read."""

import json
import os
import platform
from collections.abc import Sequence
from hashlib import sha256
from pathlib import Path
from shutil import copyfile
from typing import TYPE_CHECKING

from fmublocks.origin import located, origin_of
from toolground.atomic_files import alone, complete
from toolground.user_cache import forget, is_as_made, named_as_cache, seal, user_cache

from ...fmus.origin import is_stale, sources_digest
from .places import BUILD, BUILDS

if TYPE_CHECKING:
    from fmublocks.fmu import Fmu


def refreshed_copy(fmus: "Sequence[Fmu]", folder: Path, build: str) -> tuple[Path, list[Path]]:
    """A folder of the cache that has FMUs of the project, made from the sources that are installed, with the start
    values of those in another folder, which is only read. There is a folder for each state of the sources and each car.

    Args:
        fmus: that are needed.
        folder: whose FMUs are taken as they are where they are up to date.
        build: "python" or "native".

    Returns:
        The folder of the cache, and the files that were built.

    Raises:
        NotPossible: there is something to build, and it is not possible here.
        BuildError: start values that one was built with are refused by what it is now.
        UserError: the cache cannot be written.
    """
    from ...fmus.building.builds import rebuilt  # only where something may be made

    cache = _cache()
    kept, new = cache / _key(folder), list[Path]()
    with named_as_cache(cache), alone(kept):
        os.utime(kept)  # at once: another run that ends meanwhile forgets what was used longest ago
        for fmu in fmus:
            there, here = (located(fmu.name, each, build) for each in (folder, kept))
            if is_as_made(here) and not is_stale(here):
                continue
            if is_stale(there):
                new += rebuilt(fmu, there, kept, build)
            else:
                with complete(here) as unfinished:
                    copyfile(there, unfinished)
            seal(here)
    forget(cache.iterdir())
    return kept, new


def as_built(path: Path) -> Path:
    """Where an FMU stands that `driveline build` makes in BUILD, for one of the cache; others stand where they do."""
    cache = _cache()
    return BUILD.joinpath(*path.relative_to(cache).parts[1:]) if path.is_relative_to(cache) else path


def _cache() -> Path:
    return user_cache() / "fmus"


def _key(folder: Path) -> str:
    """Digest of what the FMUs are made from: sources, start values of those in the folder, and for which machine."""
    files = {build: sorted(located("*", folder, build).parent.glob("*.fmu")) for build in BUILDS}
    found = [(build, path.stem, origin_of(path)) for build, paths in files.items() for path in paths]
    cars = [(build, name, origin.start_values) for build, name, origin in found if origin and origin.start_values]
    made_from = [sources_digest(), cars, platform.system(), platform.machine()]
    return sha256(json.dumps(made_from, sort_keys=True).encode()).hexdigest()[:32]
