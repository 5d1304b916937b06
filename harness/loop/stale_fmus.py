"""A build that is older than its sources is not run silently, whatever runs it."""

from pathlib import Path

from ...fmus.origin import is_stale, origin_of
from ..base.collected_warnings import warn_once
from ..cosimulation.system import System


def warn_of_stale(system: System) -> None:
    """Names, once, the FMUs of a system that were not made from the sources that are installed.

    Those of the project tell what made them. Of the others, and of ours that somebody gives by their path, only those
    that tell it are judged.
    """
    found = [path for name, path in system.instances.items() if _stale(path, own=name in system.own)]
    if found:
        warn_once(f"stale, not made from the sources that are installed: {', '.join(map(str, found))}")


def _stale(path: Path, own: bool) -> bool:
    return path.is_file() and bool(own or origin_of(path)) and is_stale(path)
