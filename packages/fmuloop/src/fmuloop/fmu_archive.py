"""The archive of an FMU, which anybody may have made: looked at before anything is unpacked."""

import stat
from collections.abc import Hashable, Iterator, Sequence
from functools import lru_cache
from io import FileIO
from pathlib import Path
from typing import NamedTuple
from zipfile import ZIP_DEFLATED, ZIP_STORED, ZipFile, ZipInfo

from toolground.file_limits import LARGEST_DESCRIPTION, LARGEST_DIRECTORY, MOST_ENTRIES
from toolground.plain_text import plain, reason

from .errors import UnpackingError, WiringError
from .limits import USUAL_LIMITS, Limits

DESCRIPTION = "modelDescription.xml"

NOT_NEEDED = ("sources/", "documentation/")
"""Folders of an FMU that only people and compilers read."""

DESCRIPTIONS = (DESCRIPTION, "sources/buildDescription.xml")
"""What is read, with a limit for its size."""


class Problem(NamedTuple):
    """Why an archive is not unpacked: a rule of `driveline check`, and what breaks it."""

    rule: str
    text: str


def problems(entries: Sequence[ZipInfo], limits: Limits) -> Iterator[Problem]:
    """Everything for which an archive with these entries is not unpacked."""
    if len(entries) > MOST_ENTRIES:
        yield Problem("archive-entries", f"it has {len(entries)} entries; {MOST_ENTRIES} are allowed")
        return
    size = sum(entry.file_size for entry in entries)
    if size > limits.unpacked:
        yield Problem("archive-size", f"it unpacks to {megabytes(size)}; {megabytes(limits.unpacked)} are allowed")
    for entry in entries:
        for rule, what in _problems(entry):
            yield Problem(rule, f"{plain(entry.orig_filename)} {what}")


def megabytes(size: int) -> str:
    """A number of bytes as the option for the limit takes it, to the byte: what is just too large must not read like
    what is allowed."""
    return f"{size / 1e6:.12g} MB"


def _problems(entry: ZipInfo) -> Iterator[tuple[str, str]]:
    name = entry.orig_filename
    if name in DESCRIPTIONS and entry.file_size > LARGEST_DESCRIPTION:
        allowed = megabytes(LARGEST_DESCRIPTION)
        yield "archive-description", f"unpacks to {megabytes(entry.file_size)}; {allowed} are allowed"
    if "\\" in name:
        yield "archive-path", "has a backslash in its path"
    if name.startswith("/") or ":" in name or ".." in name.split("/"):
        yield "archive-path", "leaves the folder of the FMU"
    if stat.S_ISLNK(entry.external_attr >> 16):
        yield "archive-link", "is a link"
    if entry.flag_bits & 1:
        yield "archive-encrypted", "is encrypted"
    elif entry.compress_type not in (ZIP_STORED, ZIP_DEFLATED):
        yield "archive-method", f"is packed with the method {entry.compress_type}; FMI allows 0 and 8"


class _Bounded(FileIO):
    """An archive of which nothing but the list of its entries is read, at once."""

    def read(self, size: int | None = -1, /) -> bytes:
        if size is not None and size > LARGEST_DIRECTORY:
            raise ValueError(
                f"the list of its entries has {megabytes(size)}; {megabytes(LARGEST_DIRECTORY)} are allowed"
            )
        return super().read(size)


def entries(path: Path) -> list[ZipInfo]:
    """What is in an archive.

    Raises:
        WiringError: it is none.
    """
    try:
        with _Bounded(path, "rb") as file, ZipFile(file) as archive:
            return archive.infolist()
    except Exception as error:  # whatever strange bytes lead zipfile to
        raise WiringError(f"{path} is not an FMU: {reason(error)}") from error


def described(path: Path, limits: Limits = USUAL_LIMITS) -> bytes:
    """The model description; a file that has not changed is not read again.

    Raises:
        WiringError: the archive is none, has none, or is not to be unpacked.
    """
    return _described(path, limits, version(path))


def version(path: Path) -> Hashable:
    """What changes with the content of a file; None where there is none."""
    if not path.is_file():
        return None
    status = path.stat()
    return path.absolute(), status.st_ino, status.st_mtime_ns, status.st_size


@lru_cache(16)
def _described(path: Path, limits: Limits, _version: Hashable) -> bytes:
    contents = entries(path)
    for problem in problems(contents, limits):
        raise WiringError(f"{path} is not unpacked: {problem.text}")
    if not any(entry.filename == DESCRIPTION for entry in contents):
        raise WiringError(f"{path} is not an FMU: there is no {DESCRIPTION} in it")
    try:
        with ZipFile(path) as archive:
            return archive.read(DESCRIPTION)
    except Exception as error:
        raise WiringError(f"{path}: {DESCRIPTION} cannot be unpacked: {reason(error)}") from error


def unpack(path: Path, folder: str) -> None:
    """Unpacks what an FMU needs to run; its description must have been read before.

    Raises:
        UnpackingError: the archive is damaged, or does not fit on the disk.
    """
    try:
        with ZipFile(path) as archive:
            for name in archive.namelist():
                if not name.startswith(NOT_NEEDED):
                    archive.extract(name, folder)
    except OSError as error:
        moved = "the environment variable TMPDIR names another place"
        raise UnpackingError(f"{path.name} cannot be unpacked to {folder}: {reason(error)}; {moved}") from error
    except Exception as error:
        raise UnpackingError(f"{path.name} cannot be unpacked: {reason(error)}") from error


def damage(path: Path) -> str | None:
    """What is damaged in an archive, if anything is."""
    try:
        with ZipFile(path) as archive:
            broken = archive.testzip()
    except Exception as error:
        return reason(error)
    return broken and f"{plain(broken)} is damaged"
