"""The A2L description of a controller on the target; addresses are those of the linked image."""

from collections.abc import Mapping
from pathlib import Path

from ..child_process import output_of
from ..description import a2l
from ..fmu import Fmu

RECORDS = {"parameter": "calibration", "input": "u", "output": "y"}
"""By causality the record of link.c that holds such variables, all of single precision, one after the other."""


def description(fmu: Fmu, image: Path) -> str:
    """The A2L file for the controller in a linked image of `fmus.target.image`.

    Args:
        fmu: of that controller.
    """
    addresses = symbols(image)
    first = {causality: addresses[record] for causality, record in RECORDS.items()}
    return a2l.description(fmu, a2l.in_order(fmu.block, first, a2l.SINGLE), a2l.SINGLE)


def symbols(image: Path) -> Mapping[str, int]:
    """The addresses of what an image holds by name."""
    listing = output_of("arm-none-eabi-nm", image)
    rows = [line.split() for line in listing.splitlines()]
    return {row[2]: int(row[0], 16) for row in rows if len(row) == 3}
