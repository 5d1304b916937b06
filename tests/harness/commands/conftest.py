"""Every message that a test of a command provokes names options that the command has."""

import builtins
import re
from collections.abc import Iterator
from functools import cache
from typing import Any

import pytest

from driveline.harness.commands import cli

OPTION = re.compile(r"(?<![\w=-])--[a-z][a-z-]+")
NAMED = re.compile(r"`driveline ((?:target )?\w+)[^`]*`")


@cache
def options(command: str) -> frozenset[str]:
    """Of a command; of a name that is none: no options."""
    parser: Any = cli.parser()
    for word in command.split():
        if hasattr(parser, "add_command"):
            parser.add_command()
        (actions,) = [action for action in parser._actions if isinstance(action.choices, dict)]
        if word not in actions.choices:
            return frozenset()
        parser = actions.choices[word]
    parser.add_command()
    return frozenset(parser._option_string_actions)


def unknown_options(command: str, text: str) -> set[str]:
    """The options that a text of a command names and that neither it has nor the command that is named with them."""
    others = {
        option for other in NAMED.finditer(text) for option in OPTION.findall(other[0]) if option in options(other[1])
    }
    return set(OPTION.findall(text)) - options(command) - others


@pytest.fixture(autouse=True)
def _no_advice_that_cannot_be_followed(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    wrong: list[str] = []

    def printed(*texts: object, **how: Any) -> None:
        text = " ".join(map(str, texts))
        command, _, message = text.removeprefix("driveline ").partition(": ")
        if unknown := unknown_options(command, message) if options(command) else set():
            wrong.append(f"{command} has no {', '.join(sorted(unknown))}: {text}")
        builtins.print(*texts, **how)

    monkeypatch.setattr(cli, "print", printed, raising=False)
    yield
    assert not wrong
