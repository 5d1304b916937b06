"""What an FMU was made from, recorded inside it, so that one that is older than its sources is found."""

import hashlib
import json
import os
import zipfile
from collections.abc import Iterable, Mapping
from contextlib import suppress
from functools import cache, lru_cache
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from .errors import BuildError
from .user_cache import user_cache

if TYPE_CHECKING:
    from .fmu import Fmu

ENTRY = "extra/driveline.damping/origin.json"
"""Where it stands in the archive."""

ROOT = Path(__file__).parents[1]
"""That the packages are in."""

NATIVE_FOLDER = "native"
"""Of the native builds, in that of the others."""

PACKAGES, KINDS = ("models", "fmus"), (".py", ".c", ".h", ".toml")
"""What the sources of every FMU of the project are."""

BUILDING = ("building",)
"""Folders of what chooses the FMUs and their start values, which the origin has; it makes none of their content."""

MOST_KEPT = 50
"""States of the sources whose digest is kept."""

TOOLS = {"python": ("pythonfmu",), "native": ("fmpy",)}
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
def sources_digest() -> str:
    """That of the sources of the FMUs, as they were when this was asked first."""
    found = (
        os.path.join(folder, name)
        for package in PACKAGES
        for folder, _, names in os.walk(ROOT / package)
        for name in names
        if name.endswith(KINDS) and os.path.basename(folder) not in BUILDING
    )
    return code_digest(map(Path, found))


def code_digest(paths: Iterable[Path]) -> str:
    """SHA-256 of the code of sources of the project (`code_of`).

    It is kept in the user's cache by the bytes of the sources, as to parse them takes longer than to start.
    """
    files = {path.relative_to(ROOT).as_posix(): path for path in sorted(paths)}
    kept = user_cache() / "sources" / _digest({name: path.read_bytes() for name, path in files.items()})
    with suppress(OSError, ValueError):
        digest, check = kept.read_text(encoding="ascii").split()
        if check == _digest({digest: b""}):
            return digest
    from .source_code import code_of  # only sources that have changed are parsed

    digest = _digest({name: code_of(path).encode() for name, path in files.items()})
    with suppress(OSError):
        kept.parent.mkdir(parents=True, exist_ok=True)
        unfinished = kept.with_suffix(f".{os.getpid()}.part")
        unfinished.write_text(f"{digest} {_digest({digest: b''})}", encoding="ascii")
        os.replace(unfinished, kept)
        for old in sorted(kept.parent.iterdir(), key=lambda path: path.stat().st_mtime)[:-MOST_KEPT]:
            old.unlink(missing_ok=True)
    return digest


def _digest(contents: Mapping[str, bytes]) -> str:
    """SHA-256 of names and contents."""
    digest = hashlib.sha256()
    for name, content in contents.items():
        digest.update(f"{name}\0{len(content)}\0".encode() + content)
    return digest.hexdigest()


def located(name: str, folder: Path, build: str) -> Path:
    """Where an FMU of the project stands in the folder of the files."""
    return (folder / NATIVE_FOLDER if build == "native" else folder) / f"{name}.fmu"


def tools_of(build: str) -> dict[str, str]:
    """Versions of the packages that a build, "python" or "native", is made with."""
    return {name: version(name) for name in TOOLS[build]}


def origin_entry(fmu: "Fmu", build: str) -> dict[str, bytes]:
    """The file that tells it, by its name in the archive.

    Raises:
        BuildError: a block of the user's own has the name of one of the project, for which it would be taken.
    """
    from .catalogue import EVERY

    if fmu.name in EVERY and EVERY[fmu.name].block.module != fmu.block.module:
        raise BuildError(f"{fmu.name} is an FMU of the project, which runs by this name; give the block another name")
    entry = {"sources": sources_digest(), "start_values": dict(fmu.start_values), "tools": tools_of(build)}
    return {ENTRY: json.dumps(entry, indent=2, sort_keys=True).encode() + b"\n"}


def origin_of(path: Path) -> Origin | None:
    """What the FMU at `path` tells; None if it tells nothing (it is somebody else's, or older than this)."""
    try:
        found = path.stat()
    except OSError:
        return None
    return _read(path.absolute(), found.st_ino, found.st_mtime_ns, found.st_size)


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


def is_stale(path: Path) -> bool:
    """Whether an FMU of the project was not made from the sources that are there."""
    origin = origin_of(path)
    return origin is None or origin.sources != sources_digest()


def is_as_made_now(path: Path, fmu: "Fmu", build: str) -> bool:
    """Whether the FMU at `path` was made from the sources, start values and tools that it would be made from now."""
    origin = origin_of(path)
    now = sources_digest(), dict(fmu.start_values), tools_of(build)
    return origin is not None and (origin.sources, origin.start_values, origin.tools) == now
