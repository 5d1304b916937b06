"""The command line `driverecords`."""

from collections.abc import Sequence
from functools import partial

from toolground.parsers import several_commands
from toolground.program import run_program

DESCRIPTION = """\
Recordings of drives by any logger as checked signals in SI.

For example `driverecords look my_trip.csv`; `driverecords help look` explains it.
"""

PURPOSES = {"recordings": {"look": "say what was found in a recorded drive, and what is odd"}}

parser = partial(several_commands, "driverecords", "driverecords", DESCRIPTION, PURPOSES, "driverecords.commands")


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs `driverecords`; returns its exit code, see `run_program`."""
    return run_program("driverecords", parser, arguments)
