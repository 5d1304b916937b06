"""What a fuzz target is: something that takes input from anybody, and what it promises to answer.

Odd input by the thousand is drawn from a random generator, so that a seed tells the whole run.
"""

from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import NamedTuple

from toolground.progress import progress

Attempt = Callable[[Random], str]
"""One try: draws its input, and says in a word or two how it was answered.

Raises:
    Unclean: it was not answered as promised.
"""

FAULT = "not as promised"


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

    def counts(self, seed: int = 1, tries: int = 0, report: Callable[[str], object] = print) -> Counter[str]:
        """How often each answer was given, FAULT among them.

        Args:
            tries: 0: as many as `make fuzz` makes.
            report: gets a line for each fault, with the number of the try.
        """
        answers: Counter[str] = Counter()
        tries = tries or self.long
        with TemporaryDirectory() as folder, self.open(Path(folder)) as attempt, progress(tries, self.what) as done:
            for k in range(tries):
                try:
                    answers[attempt(Random(f"{seed} {k}"))] += 1
                except Unclean as fault:
                    answers[FAULT] += 1
                    report(f"seed {seed}, try {k}: {fault}")
                done(k + 1)
        return answers


TARGETS: dict[str, Target] = {}
"""By the names of their modules."""


def target(what: str, promise: str, short: int, long: int) -> Callable[[Callable[[Path], Iterator[Attempt]]], Target]:
    """Makes a target of a function that yields the attempt."""

    def made(attempts: Callable[[Path], Iterator[Attempt]]) -> Target:
        found = Target(what, promise, contextmanager(attempts), short, long)
        return TARGETS.setdefault(attempts.__module__.rpartition(".")[2], found)

    return made
