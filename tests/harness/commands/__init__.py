from typing import Any

import pytest

from driveline.harness.commands.arguments import filled
from driveline.harness.commands.cli import parser

Capsys = pytest.CaptureFixture[str]


def given(*words: str) -> Any:
    """The record that a command gets of these words."""
    args = parser().parse_args(words)
    return filled(args.found.record, args)
