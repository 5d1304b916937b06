"""What an FMU was made from, recorded inside it, so that one that is older than its sources is found."""

import json
import zipfile
from collections.abc import Mapping
from functools import cache, lru_cache
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from toolground.digest import digest_of_files

if TYPE_CHECKING:
    from .fmu import Fmu

ENTRY = "extra/fmublocks/origin.json"
"""Where it stands in the archive."""

NATIVE_FOLDER = "native"
"""Of the native builds, in that of the others."""

KINDS = (".py", ".c", ".h", ".toml")
"""What sources are."""

TOOLS: Mapping[str, tuple[str, ...]] = {"python": ("pythonfmu",), "native": ()}
"""Packages that each build is made with."""


class Origin(NamedTuple):
    """What an FMU tells of itself.

    Attributes:
        sources: digest of the code that made it, as of `sources_digest`.
        start_values: of the parameters that a vehicle file or gains have set, by name.
        platforms: for which it has binaries.
        tools: versions of the packages that it was made with.
    """

    sources: str
    start_values: Mapping[str, Any]
    platforms: frozenset[str]
    tools: Mapping[str, str] = {}


@cache
def sources_digest(sources: Path | None) -> str:
    """That of this package and of the folder that holds the equations, as they were when this was asked first."""
    folders = [Path(__file__).parent, *([sources] if sources else [])]
    return digest_of_files(path for folder in folders for path in folder.rglob("*") if path.suffix in KINDS)


def located(name: str, folder: Path, build: str) -> Path:
    """Where an FMU stands in the folder of the files."""
    return (folder / NATIVE_FOLDER if build == "native" else folder) / f"{name}.fmu"


def tools_of(build: str) -> dict[str, str]:
    """Versions of the packages that a build, "python" or "native", is made with."""
    return {name: version(name) for name in TOOLS[build]}


def origin_entry(fmu: "Fmu", build: str) -> dict[str, bytes]:
    """The file that tells it, by its name in the archive."""
    entry = {
        "sources": sources_digest(fmu.sources),
        "start_values": dict(fmu.start_values),
        "tools": tools_of(build),
    }
    return {ENTRY: json.dumps(entry, indent=2, sort_keys=True).encode() + b"\n"}


def origin_of(path: Path) -> Origin | None:
    """What the FMU at `path` tells; None if it tells nothing (it is somebody else's, or older than this)."""
    try:
        status = path.stat()
    except OSError:
        return None
    return _read(path.absolute(), status.st_ino, status.st_mtime_ns, status.st_size)


@lru_cache(64)
def _read(path: Path, *_: int) -> Origin | None:
    """Of a file with these properties, which another would not have: every run asks for it."""
    try:
        with zipfile.ZipFile(path) as archive:
            entry = json.loads(archive.read(ENTRY))
            binaries = [name.split("/")[1] for name in archive.namelist() if name.startswith("binaries/")]
        return Origin(entry["sources"], dict(entry["start_values"]), frozenset(binaries), entry.get("tools", {}))
    except Exception:  # whatever the bytes of a stranger lead zipfile to
        return None


def is_as_made_now(path: Path, fmu: "Fmu", build: str) -> bool:
    """Whether the FMU at `path` was made from the sources, start values and tools that it would be made from now."""
    origin = origin_of(path)
    now = sources_digest(fmu.sources), dict(fmu.start_values), tools_of(build)
    return origin is not None and (origin.sources, origin.start_values, origin.tools) == now
