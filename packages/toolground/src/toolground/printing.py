"""What a command prints: for people, or with --json one document for tools, or with --quiet only what goes wrong."""

import json
from collections.abc import Iterable
from contextlib import suppress
from itertools import groupby
from pathlib import Path
from typing import Any

from .arguments import option, record

FIGURES = (".png", ".pdf", ".svg")
"""Endings of figures."""


@record
class Printing:
    """What a command may print."""

    quiet: bool = option(False, "print only what goes wrong")

    @property
    def silent(self) -> bool:
        """Whether nothing is printed for people but what goes wrong."""
        return self.quiet or getattr(self, "json", False)

    def say(self, text: str) -> None:
        """A line for people. Where nobody reads it any more, what runs goes on all the same."""
        if not self.silent:
            with suppress(BrokenPipeError):
                print(text)

    def written(self, paths: Iterable[Path]) -> None:
        """A line for each file that was written, one for all kinds of a figure."""
        for _, alike in groupby(paths, lambda path: path.with_suffix("") if path.suffix in FIGURES else path):
            first, *others = alike
            beside = f" (and {', '.join(other.suffix for other in others)})" if others else ""
            self.say(f"written: {first}{beside}")

    def document(self, content: Any) -> None:
        """The document for tools."""
        if getattr(self, "json", False):
            print(json.dumps(content, indent=2, allow_nan=False, default=str))


@record
class JsonPrinting(Printing):
    """Of a command that prints a table."""

    json: bool = option(False, "print one JSON document in the place of the table")
