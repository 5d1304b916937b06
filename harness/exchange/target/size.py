"""What the controller takes on the target beside time: flash, RAM and stack."""

import re
from pathlib import Path
from typing import NamedTuple

from ....fmus.child_process import output_of
from ....fmus.target.link import Link

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


def size_of(image: Path, name: str, link: Link) -> Size:
    """
    Args:
        image: of `fmus.target.image`, with what was made with it beside it.
        name: of the controller's files.
        link: to the program in it, which says how many numbers of 4 bytes its records have.
    """
    stacks = (image.parent / f"{name}.su").read_text(encoding="utf-8").splitlines()
    members = re.findall(r"^\S+\(lib_a-(\w+)\.o\)", image.with_suffix(".map").read_text(encoding="utf-8"), re.MULTILINE)
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
