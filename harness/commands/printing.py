"""What a command prints: for people, or with --json one document for tools, or with --quiet only what goes wrong."""

import argparse
import json
from collections.abc import Iterable
from contextlib import suppress
from itertools import groupby
from pathlib import Path
from typing import Any

from ..views.figure_options import KINDS


class Printer:
    """Prints what the options of a command let it print.

    Attributes:
        silent: nothing is printed for people but what goes wrong.
        json: a document is printed.
    """

    def __init__(self, args: argparse.Namespace) -> None:
        self.json = getattr(args, "json", False)
        self.silent = args.quiet or self.json

    def say(self, text: str) -> None:
        """A line for people. Where nobody reads it any more, what runs goes on all the same."""
        if not self.silent:
            with suppress(BrokenPipeError):
                print(text)

    def files(self, paths: Iterable[Path]) -> None:
        """A line for each file that was written, one for all kinds of a figure."""
        for _, alike in groupby(paths, lambda path: path.with_suffix("") if path.suffix[1:] in KINDS else path):
            first, *others = alike
            beside = f" (and {', '.join(other.suffix for other in others)})" if others else ""
            self.say(f"written: {first}{beside}")

    def document(self, content: Any) -> None:
        """The document for tools."""
        if self.json:
            print(json.dumps(content, indent=2, allow_nan=False, default=str))
