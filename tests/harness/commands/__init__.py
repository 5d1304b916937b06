from typing import Any

import pytest

from driveline.harness.commands.cli import main, parser
from toolground.arguments import filled

Capsys = pytest.CaptureFixture[str]


def answer(capsys: Capsys, *words: str) -> tuple[Any, str, str]:
    """Exit code and what stands on stdout and stderr."""
    capsys.readouterr()
    try:
        code: Any = main(words)
    except SystemExit as end:
        code = end.code
    printed = capsys.readouterr()
    return code, printed.out, printed.err


def given(*words: str) -> Any:
    """The record that a command gets of these words."""
    args = parser().parse_args(words)
    return filled(args.found.record, args)
