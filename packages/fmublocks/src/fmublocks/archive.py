"""The file of an FMU: the same content gives the same bytes, with sorted names and the date of the release."""

import hashlib
import os
import uuid
import zipfile
from collections.abc import Mapping
from errno import ELOOP
from pathlib import Path

from .release import date


def write_archive(files: Mapping[str, bytes], target: Path) -> None:
    """Writes the zip archive; one that is there is replaced when the new one is complete. A link stays one.

    Raises:
        OSError: its folder is a file, or what has its name is no file, or links lead round in a circle; it cannot be
            written, as on a full disk.
    """
    link, target = target, Path(os.path.realpath(target))
    if target.is_symlink():
        raise OSError(ELOOP, os.strerror(ELOOP), str(link))
    if target.parent.exists() and not target.parent.is_dir():
        raise NotADirectoryError(f"{target.parent} is a file; a folder is needed")
    if target.exists() and not target.is_file():
        raise FileExistsError(f"{target} is no file and is not replaced by an FMU")
    target.parent.mkdir(parents=True, exist_ok=True)
    unfinished = target.with_suffix(f".{os.getpid()}.part")
    try:
        _write(files, unfinished)
        os.replace(unfinished, target)
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(target)) from error
    finally:
        unfinished.unlink(missing_ok=True)


def _write(files: Mapping[str, bytes], target: Path) -> None:
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name in sorted(files):
            entry = zipfile.ZipInfo(name, date().timetuple()[:6])
            entry.create_system, entry.external_attr = 3, 0o100644 << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, files[name])


def guid_of(description: bytes, files: Mapping[str, bytes]) -> str:
    """A GUID that changes with the model description and with the files."""
    digest = hashlib.sha256(description)
    for name in sorted(files):
        digest.update(hashlib.sha256(name.encode()).digest() + hashlib.sha256(files[name]).digest())
    return f"{{{uuid.UUID(bytes=digest.digest()[:16])}}}"
