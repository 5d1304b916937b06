"""The course of commands that make one run of the loop and write its signals."""

import argparse
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..loop.settings import Settings, loop
from ..manoeuvres.manoeuvre import Manoeuvre
from .course import RunJob, job
from .frames import require_frames, write_frames
from .settings import distinguishing, other_format

if TYPE_CHECKING:
    import numpy as np

    from ..cosimulation.results import Results


@contextmanager
def signals_job(
    args: argparse.Namespace, given: Settings, manoeuvre: Manoeuvre, run: Mapping[str, Any], read: Iterable[Path] = ()
) -> Iterator[RunJob]:
    """As `harness.commands.course.job`, for files at `stem_of`.

    Args:
        run: what distinguishes it beside settings, manoeuvre and format.

    Raises:
        DrivelineError: there are results of another run, or no frames where --frames asks for them.
    """
    from ..views.signals_file import signals_path

    require_frames(args, loop(given).own)
    stem = stem_of(args, given, manoeuvre)
    same = {**run, "damping": args.control} | distinguishing(given, manoeuvre) | other_format(args)
    record, signals = stem.with_name(f"{stem.name}.json"), signals_path(stem, args.format)
    with job(args, record, same, {given.plant_name: given}, [signals], list(read)) as made:
        yield made


def stem_of(args: argparse.Namespace, given: Settings, manoeuvre: Manoeuvre) -> Path:
    """PLANT_MANOEUVRE_CONTROL in the folder for the results, the files without their endings."""
    return args.output / f"{given.plant_name}_{manoeuvre.name}_{args.control}"


def write_run(
    args: argparse.Namespace,
    made: RunJob,
    given: Settings,
    manoeuvre: Manoeuvre,
    results: "Results",
    signals: "np.ndarray",
) -> None:
    """Writes signals, and the frames of the results where they are asked for."""
    from ..views.signals_file import write_signals

    stem = stem_of(args, given, manoeuvre)
    made.wrote(write_signals(signals, stem, args.format))
    made.wrote(*write_frames(args, results, made.fits[given.plant_name], given.parameters, stem))
