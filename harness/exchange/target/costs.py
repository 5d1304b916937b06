"""What the controller takes on the target: flash, RAM and stack, and its time under a timer's interrupt."""

import re
import struct
import subprocess
from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from fmublocks.target.image import SCHEDULER, target_image
from fmublocks.target.link import TargetError, emulated
from toolground.child_process import output_of, run

from .controllers import Programs

FLASH_SECTIONS = re.compile(r"^\.(?:text|rodata|data)\S*\s+(\d+)", re.MULTILINE)


class Size(NamedTuple):
    """In bytes.

    Attributes:
        flash: code and constants of the controller.
        image: of the whole image, with the link, the board and the library.
        ram: two states, inputs and outputs.
        calibration: its parameters, where they lie in RAM.
        stack: of its hungriest function, as the compiler counts; none calls another.
        library: what of the C library the image holds.
    """

    flash: int
    image: int
    ram: int
    calibration: int
    stack: int
    library: tuple[str, ...]


def size_of(programs: Programs) -> Size:
    """What the image holds, and what was written beside it when it was made."""
    image, name = programs.image, programs.name
    stacks = (image.parent / f"{name}.su").read_text(encoding="utf-8").splitlines()
    members = re.findall(r"^\S+\(lib_a-(\w+)\.o\)", image.with_suffix(".map").read_text(encoding="utf-8"), re.MULTILINE)
    with programs.target() as link:
        return Size(
            flash=_flash(image.parent / f"{name}.o"),
            image=_flash(image),
            ram=4 * (2 * link.states + link.inputs + link.outputs),
            calibration=4 * link.parameters,
            stack=max(int(line.split("\t")[1]) for line in stacks),
            library=tuple(sorted(set(members))),
        )


def _flash(path: Path) -> int:
    listing = output_of("arm-none-eabi-size", "-A", path)
    return sum(map(int, FLASH_SECTIONS.findall(listing)))


TIME_LIMIT = 60.0
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
            done = run(command, Path(temporary), timeout=TIME_LIMIT, text=False)
        except subprocess.TimeoutExpired as error:
            raise TargetError(f"the scheduler on the emulated target has not ended within {TIME_LIMIT:g} s") from error
    if done.returncode or len(done.stdout) != 4 * len(Schedule._fields):
        raise TargetError(f"the scheduler on the emulated target crashed: exit code {done.returncode}")
    return Schedule(*struct.unpack(f"<{len(Schedule._fields)}I", done.stdout))
