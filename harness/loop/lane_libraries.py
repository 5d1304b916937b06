"""Libraries of the project's blocks for several cars at a time, made when needed and kept in the user's cache."""

import logging
import zipfile
from ctypes import CDLL
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING

from fmuloop.system import System
from toolground.lanes_here import lanes_here
from toolground.user_cache import kept, user_cache

from ...fmus.origin import is_stale, sources_digest

if TYPE_CHECKING:
    from fmublocks.fmu import Fmu

LOG = logging.getLogger(__name__)

IN_NATIVE = "sources/all.c"
"""Is in native FMUs alone."""


def lane_libraries(system: System) -> dict[str, CDLL] | None:
    """The library of each instance; None where one is no native FMU of the project, made from the sources that are
    here, or libraries cannot be made, and the log says why."""
    if other := [name for name, path in system.instances.items() if name not in system.own or not _is_ours(path)]:
        LOG.info("%s: its runs are made one after the other; lanes are for the project's native FMUs", other[0])
        return None
    found = {name: _library(path.stem, sources_digest()) for name, path in system.instances.items()}
    return {name: library for name, library in found.items() if library} if all(found.values()) else None


@cache
def _blocks() -> "dict[str, Fmu]":
    """All that can stand in a loop, by name."""
    from ...fmus.catalogue import EVERY, SIGNAL_FAULTS

    return {**EVERY, SIGNAL_FAULTS.name: SIGNAL_FAULTS}


def _is_ours(path: Path) -> bool:
    if is_stale(path):
        return False
    with zipfile.ZipFile(path) as archive:
        return IN_NATIVE in archive.namelist()


@cache
def _library(name: str, sources: str) -> CDLL | None:
    """That of a block; None if it cannot be made here."""
    lanes = lanes_here()
    path = user_cache() / "lanes" / sources[:32] / f"{name}-{lanes}.so"
    try:
        return CDLL(str(kept(path, partial(_make, name, lanes))))
    except Exception as reason:  # it is faster, but needed for nothing
        LOG.info("%s: its runs are made one after the other, as there is no library for lanes: %s", name, reason)
        return None


def _make(name: str, lanes: int, path: Path) -> None:
    from fmublocks.native.lanes import build_lanes

    build_lanes(_blocks()[name], lanes, path)
