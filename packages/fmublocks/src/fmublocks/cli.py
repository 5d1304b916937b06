"""The command line `fmublocks`."""

from collections.abc import Sequence
from functools import partial

from toolground.parsers import several_commands
from toolground.program import run_program

DESCRIPTION = """\
A block in Python becomes FMUs, C for a processor, WebAssembly.

For example `fmublocks build my_block.py`; `fmublocks help COMMAND` explains a command.
"""

PURPOSES = {
    "blocks": {
        "build": "build FMUs, native ones or in Python",
        "c": "write the C of a sampled block, for a processor",
        "wasm": "make a WebAssembly module of an FMU",
    }
}

parser = partial(several_commands, "fmublocks", "fmublocks", DESCRIPTION, PURPOSES, "fmublocks.commands")


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs `fmublocks`; returns its exit code, see `run_program`."""
    return run_program("fmublocks", parser, arguments)
