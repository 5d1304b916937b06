"""--frames: the frames of a run as a log of the bus, with its database."""

import argparse
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..base.errors import DrivelineError
from ..base.optional_packages import required

if TYPE_CHECKING:
    import numpy as np

    from ..cosimulation.wiring import Fit

LOGS = ("asc", "blf")
BLOCKS = ("can", "motor")
"""Whose frames they are."""


def add_frames(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--frames", choices=LOGS, help="write the frames of the bus too, as a log in this format, with its DBC"
    )


def require_frames(args: argparse.Namespace, own: frozenset[str]) -> None:
    """
    Args:
        own: the places in which there are blocks of ours.

    Raises:
        DrivelineError: there are FMUs in the loop that declare no frames.
        MissingExtra: the packages are not installed.
    """
    if args.frames is None:
        return
    if others := [place for place in BLOCKS if place not in own]:
        raise DrivelineError(f"--frames: {', '.join(getattr(args, place) for place in others)} declares no frames")
    for package in ("can", "cantools"):
        required(package, "a log of the bus", "recordings")


def write_frames(
    args: argparse.Namespace, results: "np.ndarray", fitted: "Fit", given: Mapping[str, Any], stem: Path
) -> list[Path]:
    """Writes log and database, if they are asked for; returns the files.

    Args:
        given: parameters that the run has set.
        stem: path of the files without their ending.
    """
    if args.frames is None:
        return []
    from ..exchange.bus.database import telegrams, write_dbc
    from ..exchange.bus.log import write_log

    sent = telegrams(fitted.parameters(given))
    log, database = (stem.with_name(f"{stem.name}.{ending}") for ending in (args.frames, "dbc"))
    write_log(sent, results, log)
    write_dbc(sent, database)
    return [log, database]
