"""The controller under a timer's interrupt on the emulated target: whether the sample is kept."""

import struct
import subprocess
from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from ....fmus.child_process import run
from ....fmus.target.image import SCHEDULER, target_image
from ....fmus.target.link import TargetError, emulated

LIMIT = 60.0
"""Longest time in s that it may run."""


class Schedule(NamedTuple):
    """What the example scheduler.c has seen, as it sends it; times are in ticks of its timer.

    Attributes:
        samples, missed: made, and interrupts that came before the one before was done.
        period: of the sample.
        latency: from the timer to the interrupt's function, the longest.
        response: from the timer to the end of the sample, the longest.
        watchdog: what its counter had come to at the most, of two periods.
    """

    samples: int
    missed: int
    period: int
    latency: int
    response: int
    watchdog: int


def schedule(sources: Mapping[str, str]) -> Schedule:
    """Compiles and runs it.

    Args:
        sources: of a controller, in single precision.

    Raises:
        CompilerError: the compiler or the emulator is missing.
        TargetError: it has not ended as it should.
    """
    with TemporaryDirectory(prefix="driveline-") as temporary:
        command = emulated(target_image(sources, Path(temporary), SCHEDULER))
        try:
            done = run(command, Path(temporary), timeout=LIMIT, text=False)
        except subprocess.TimeoutExpired as error:
            raise TargetError(f"the scheduler on the emulated target has not ended within {LIMIT:g} s") from error
    if done.returncode or len(done.stdout) != 4 * len(Schedule._fields):
        raise TargetError(f"the scheduler on the emulated target crashed: exit code {done.returncode}")
    return Schedule(*struct.unpack(f"<{len(Schedule._fields)}I", done.stdout))
