"""The FMUs of a campaign: whoever runs its cases, on whatever machine, has the same ones at the same paths."""

from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path
from typing import TypeVar

from fmuloop.system import System
from toolground.digest import digest
from toolground.errors import UserError

from ..loop.resolved import ResolvedLoop
from ..loop.settings import Settings


def absolute(block: str) -> str:
    """A block by its name, or the whole path of an FMU."""
    return str(Path(block).absolute()) if Path(block).suffix == ".fmu" else block


L = TypeVar("L", ResolvedLoop, Settings)


def anywhere(loop: L) -> L:
    """The same with whole paths, so that any process can make the runs."""
    settings = loop.settings if isinstance(loop, ResolvedLoop) else loop
    blocks = {place: absolute(str(block)) for place, block in settings.blocks.items()}
    return loop.replace(**blocks, folder=settings.folder.absolute())  # type: ignore[arg-type]


def digests(systems: Iterable[System]) -> dict[Path, str]:
    """Of the FMUs of the systems, in their order."""
    paths = dict.fromkeys(path.absolute() for system in systems for path in system.instances.values())
    return {path: digest(path) for path in paths}


def require_same_fmus(expected: Mapping[Path, str]) -> None:
    """Refuses other FMUs than those with these digests.

    Raises:
        UserError: one is absent here or has another content.
    """
    for path, its in expected.items():
        if not path.is_file():
            raise UserError(f"there is no FMU {path}; all that run cases need it at this path")
        status = path.stat()
        if _digest(path, status.st_mtime_ns, status.st_size) != its:
            raise UserError(f"{path} is not the one that the campaign was begun with")


@cache
def _digest(path: Path, written: int, size: int) -> str:
    """Of a file, read again when it has been written."""
    return digest(path)
