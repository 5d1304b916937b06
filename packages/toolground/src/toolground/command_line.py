"""The command that runs, for the record of what it makes."""

import shlex
import sys
from contextvars import ContextVar

words: ContextVar[list[str] | None] = ContextVar("words", default=None)
"""With the name of the program; None where a program of somebody else runs."""


def command_line() -> str:
    """As a shell takes it."""
    arguments = words.get()
    return shlex.join(sys.argv if arguments is None else arguments)
