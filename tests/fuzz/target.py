"""What a fuzz target is."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path
from random import Random
from typing import NamedTuple

Attempt = Callable[[Random], str]
"""One try: draws its input, and says in a word or two how it was answered.

Raises:
    Unclean: it was not answered as promised.
"""


class Unclean(Exception):
    """An answer that must not be; the message holds what was tried."""


class Target(NamedTuple):
    """Something that takes input from anybody.

    Attributes:
        what: is tried.
        promise: what the answer to any input is.
        open: gives the attempt, for as long as it is used; the folder is for what it needs, and is empty.
        short: tries in the tests.
        long: tries of `make fuzz`.
    """

    what: str
    promise: str
    open: Callable[[Path], AbstractContextManager[Attempt]]
    short: int
    long: int
