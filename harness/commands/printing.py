"""What a command prints: for people, or with --json one document for tools, or with --quiet only what goes wrong."""

import argparse
import json
from typing import Any


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
        """A line for people."""
        if not self.silent:
            print(text)

    def document(self, content: Any) -> None:
        """The document for tools."""
        if self.json:
            print(json.dumps(content, indent=2, allow_nan=False, default=str))
