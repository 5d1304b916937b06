"""The command line `fmucheck`."""

from collections.abc import Sequence
from functools import partial

from toolground.parsers import single_command
from toolground.program import run_program

parser = partial(single_command, "fmucheck", "fmucheck", "fmucheck.command")


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs `fmucheck`; returns its exit code, see `run_program`."""
    return run_program("fmucheck", parser, arguments)
