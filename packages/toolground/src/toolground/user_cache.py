"""What is made once and kept for the next time, in the user's folder for that: each file with a seal beside it: its
digest, and what it was made for."""

import os
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from shutil import rmtree

from .atomic_files import complete, write_text
from .digest import digest
from .errors import UserError
from .plain_text import plain

MOST_KEPT = 20
"""Folders of a kind that are kept, those that were used last."""

MOVED_BY = "LOCALAPPDATA" if sys.platform == "win32" else "XDG_CACHE_HOME"
"""The environment variable that names another place for it."""


def user_cache() -> Path:
    """`$XDG_CACHE_HOME/driveline-damping` or `~/.cache/driveline-damping`, or what other systems have for it."""
    import platformdirs  # only what makes something asks for it

    return platformdirs.user_cache_path("driveline-damping")


@contextmanager
def named_as_cache(folder: Path) -> Iterator[None]:
    """Within it a folder of the cache is written to.

    Raises:
        UserError: it cannot be; says that it is the cache, and what moves it.
    """
    try:
        yield
    except OSError as error:
        at = Path(error.filename or folder)
        if not (at.is_relative_to(folder) or folder.is_relative_to(at)):
            raise
        raise UserError(
            f"the cache {plain(folder)} cannot be written: {plain(error.strerror or error)}; "
            f"the environment variable {MOVED_BY} names another place"
        ) from error


def kept(path: Path, make: Callable[[Path], object]) -> Path:
    """A file of the cache, which is made if it is not there as it was made; its folder has been used then.

    Args:
        make: writes it to another path.
    """
    if not is_as_made(path):
        with complete(path) as unfinished:
            make(unfinished)
        seal(path)
    with suppress(OSError):  # of a cache that this user only reads
        os.utime(path.parent)
    forget(path.parent.parent.iterdir())
    return path


def seal(path: Path) -> None:
    """Keeps the seal of a file of the cache that has just been made."""
    write_text(_sealed(path), _seal(path))


def is_as_made(path: Path) -> bool:
    """Whether a file is there as it was when it was sealed. A library that is cut off would end the process that loads
    it, one that is damaged gives wrong numbers."""
    with suppress(OSError):
        return _seal(path).read_bytes() == _sealed(path).encode()
    return False


def _sealed(path: Path) -> str:
    """With its folder, which is named by all that it was made of: another entry with its seal is none of this place."""
    return f"{digest(path)} {'/'.join(path.parts[-3:])}"


def _seal(path: Path) -> Path:
    return path.with_name(f"{path.name}.digest")


def forget(folders: Iterable[Path]) -> None:
    """Removes all but the MOST_KEPT of the folders that were used last, by the time of their last change."""
    for folder in sorted(folders, key=_last_used)[:-MOST_KEPT]:
        rmtree(folder, ignore_errors=True)


def _last_used(folder: Path) -> float:
    """Instant in s; 0 of a folder that another process has just forgotten."""
    try:
        return folder.stat().st_mtime
    except FileNotFoundError:
        return 0.0
