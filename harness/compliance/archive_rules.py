"""Rules for the archive of an FMU."""

from collections.abc import Iterator
from pathlib import Path, PurePosixPath
from zipfile import BadZipFile, ZipFile

EXPECTED = {
    "modelDescription.xml": "FMI asks for it",
    "documentation/index.html": "the page that tools show",
    "model.png": "the picture that tools show",
}

EXTENSIONS = {".so", ".dll", ".dylib"}


def archive(path: Path) -> Iterator[str]:
    """Files that are missing, or that some host cannot unpack or should not find."""
    try:
        with ZipFile(path) as file:
            broken = file.testzip()
            entries = file.infolist()
    except BadZipFile as error:
        yield f"it is not a zip archive: {error}"
        return
    if broken:
        yield f"{broken} is damaged"
    names = [entry.orig_filename for entry in entries]
    for name, why in EXPECTED.items():
        if name not in names:
            yield f"{name} is missing ({why})"
    binaries = {PurePosixPath(name).suffix for name in names if name.startswith("binaries/")}
    if not binaries & EXTENSIONS:
        yield "there is no binary for any platform"
    for name in sorted({name for name in names if names.count(name) > 1}):
        yield f"{name} is there more than once"
    for name in names:
        yield from _path_problems(name)


def _path_problems(name: str) -> Iterator[str]:
    parts = PurePosixPath(name).parts
    if "\\" in name:
        yield f"{name} has a backslash in its path"
    if name.startswith("/") or ".." in parts:
        yield f"{name} leaves the folder of the FMU"
    if not name.isascii():
        yield f"{name} is not plain ASCII"
    if "__pycache__" in parts or name.endswith(".pyc"):
        yield f"{name} is a leftover of the Python that built it"
