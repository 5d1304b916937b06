"""Files that are complete or absent."""

import logging
import os
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from contextvars import ContextVar
from errno import ELOOP, ENOLCK, ENOSPC, ENOTSUP
from pathlib import Path

from .interruption import unswallowed

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None

LOG = logging.getLogger(__name__)

DEVICES = (Path("/dev"), Path("/dev/fd"), Path("/proc/self/fd"))


@contextmanager
def complete(path: Path) -> Iterator[Path]:
    """A path to write to; what is there at the end of the block becomes the file at `path`, after an error nothing.

    The folder is made if absent. A link stays one, and the file that it leads to is replaced. What is no regular file
    (a device, a pipe that somebody reads) is never replaced but written to, as is whatever stands among the devices:
    /dev/stdout may be a file.

    Raises:
        IsADirectoryError: there is a folder of that name.
        OSError: links lead round in a circle; it is a pipe that nobody reads; it cannot be written, as on a full disk.
    """
    if path.is_dir():
        raise IsADirectoryError(f"{path} is a folder; a file is needed")
    if path.exists() and not replaceable(path):
        with naming(path), _read(path):
            yield path
        return
    path = destination(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    unfinished = path.with_name(f"{path.name}.{os.getpid()}.part")
    with naming(path, unfinished), _noted(unfinished):
        try:
            yield unfinished
            _set_aside(path)
            os.replace(unfinished, path)
        finally:
            unfinished.unlink(missing_ok=True)


_before: ContextVar[dict[Path, Path | None] | None] = ContextVar("before", default=None)
"""Files that were completed or removed, each with where the one stands that was there before, if there was one."""


@contextmanager
def as_before_if_stopped() -> Iterator[None]:
    """Files that were completed or removed within it are as they were before when it is stopped."""
    before: dict[Path, Path | None] = {}
    outer = _before.set(before)
    try:
        with unswallowed():
            yield
    except KeyboardInterrupt:
        for path, old in before.items():
            if old is None:
                path.unlink(missing_ok=True)
            elif old.is_file():
                os.replace(old, path)
        raise
    finally:
        for old in before.values():
            if old is not None:
                old.unlink(missing_ok=True)
        _before.reset(outer)


@contextmanager
def unchanged_if_stopped(pattern: str, *folders: Path) -> Iterator[None]:
    """Small files of that pattern in folders, and the folders, are as they were before when it is stopped; for what
    other threads write, which end after it was stopped."""

    def matching() -> set[Path]:
        return {path for folder in folders for path in folder.glob(pattern)}

    there = {path: path.read_bytes() for path in matching()}
    absent = {path for folder in folders for path in (folder, *folder.parents) if not path.exists()}
    try:
        with unswallowed():
            yield
    except KeyboardInterrupt:
        for path in matching() - there.keys():
            path.unlink()
        for path, content in there.items():
            if path.read_bytes() != content:
                with complete(path) as unfinished:
                    unfinished.write_bytes(content)
        for folder in sorted(absent, reverse=True):
            with suppress(OSError):  # it was never made, or there is something in it
                folder.rmdir()
        raise


def _set_aside(path: Path) -> None:
    """Keeps a file that will be replaced or removed, see `as_before_if_stopped`."""
    if (before := _before.get()) is None or path in before:
        return
    if not path.is_file():
        before[path] = None
        return
    old = path.with_name(f"{path.name}.{os.getpid()}.before.part")
    old.unlink(missing_ok=True)  # of a killed process of the same number
    before[path] = old
    try:
        os.link(path, old)  # one of both versions is at the path even if the process is killed
    except OSError:  # not every file system has links
        os.replace(path, old)


@contextmanager
def naming(file: str | Path, unfinished: Path | None = None) -> Iterator[None]:
    """An error of the system that names no file, as that of a full disk, or names the unfinished one names this. What
    cannot be copied to names what it is copied from first."""
    try:
        yield
    except OSError as error:
        full = error.errno == ENOSPC and error.filename2 is not None
        named = error.filename2 if full else error.filename
        if error.errno is None or (named is not None and str(named) != str(unfinished)):
            raise
        raise OSError(error.errno, error.strerror, str(file)) from error


@contextmanager
def alone(folder: Path) -> Iterator[None]:
    """Within it no other process is in such a block for the folder, which is made if absent; nothing of it stays.

    Windows and some file systems of networks lock no folders, and nobody waits there.
    """
    folder.mkdir(parents=True, exist_ok=True)
    if fcntl is None:
        yield
        return
    number = os.open(folder, os.O_RDONLY)
    try:
        try:
            fcntl.flock(number, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            LOG.warning("another run writes to %s; this one waits for it", folder)
            fcntl.flock(number, fcntl.LOCK_EX)
        except OSError as error:
            if error.errno not in (ENOLCK, ENOTSUP):
                raise
        yield
    finally:
        os.close(number)


def replaceable(path: Path) -> bool:
    """Whether it is a regular file, or a link to one, and not among the devices."""
    return path.is_file() and path.absolute().parent not in DEVICES


def remove(path: Path) -> None:
    """Removes a file if it is there; a link stays one, and so does what is not to be replaced."""
    if replaceable(path) or not path.exists():
        _set_aside(destination(path))
        destination(path).unlink(missing_ok=True)


@contextmanager
def _read(path: Path) -> Iterator[None]:
    """Holds a pipe open for writing; one that nobody reads would let the writer wait for ever.

    Raises:
        OSError: it is such a pipe.
    """
    if not path.is_fifo():
        yield
        return
    try:
        held = os.open(path, os.O_WRONLY | os.O_NONBLOCK)
    except OSError as error:
        raise OSError(error.errno, "it is a pipe that nobody reads", str(path)) from error
    try:
        yield
    finally:
        os.close(held)


_notes: Path | None = None


def note_unfinished(folder: Path) -> None:
    """From now on this process notes in a folder what it has begun to write, for `remove_unfinished`."""
    global _notes
    _notes = folder


def remove_unfinished(folder: Path) -> None:
    """Removes what processes that were killed while they wrote, and had noted it in the folder, have left."""
    for note in folder.glob("*.unfinished"):
        if (text := note.read_text(encoding="utf-8")).endswith(".part"):
            Path(text).unlink(missing_ok=True)


@contextmanager
def _noted(unfinished: Path) -> Iterator[None]:
    if _notes is None:
        yield
        return
    note = _notes / f"{unfinished.name}.unfinished"
    note.write_text(str(unfinished.absolute()), encoding="utf-8")
    try:
        yield
    finally:
        note.unlink(missing_ok=True)


def destination(path: Path) -> Path:
    """Where links lead.

    Raises:
        OSError: round in a circle.
    """
    end = Path(os.path.realpath(path))
    if end.is_symlink():
        raise OSError(ELOOP, os.strerror(ELOOP), str(path))
    return end


def write_text(text: str, path: Path) -> None:
    """Writes a text file as UTF-8."""
    with complete(path) as unfinished:
        unfinished.write_text(text, encoding="utf-8")


def write_texts(files: Mapping[Path, str]) -> None:
    """Writes several files, all or none."""
    with ExitStack() as all_or_none:
        for path, text in files.items():
            all_or_none.enter_context(complete(path)).write_text(text, encoding="utf-8")
