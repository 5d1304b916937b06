"""A command has the options that it and its helpers ask for."""

import ast
import inspect
from argparse import ArgumentParser
from collections.abc import Iterator
from textwrap import dedent
from typing import Any

import pytest

from driveline.harness.commands.cli import COMMANDS, command
from driveline.harness.commands.study import ACTIONS

LEADING = [name for name in COMMANDS if name not in ("target", "study")] + [name for name, _ in ACTIONS.values()]
"""Those that have no commands of their own, and those of `study`."""


def asked_for(function: Any, args: str = "args") -> Iterator[str]:
    """What a function reads of its arguments, and those do that it hands all of them on to."""
    called = function.__init__ if inspect.isclass(function) else function
    tree, known = ast.parse(dedent(inspect.getsource(called))), called.__globals__
    for node in ast.walk(tree):
        match node:
            case ast.Attribute(value=ast.Name(id=name), attr=option) if name == args:
                yield option
            case ast.Call(func=ast.Name(id=helper), args=[ast.Name(id=name), *_]) if name == args and helper in known:
                yield from asked_for(known[helper])
            case ast.Call(func=ast.Attribute(value=ast.Name(id=module), attr=helper), args=[ast.Name(id=name), *_]):
                if name == args and module in known:
                    yield from asked_for(getattr(known[module], helper))


@pytest.mark.parametrize("name", LEADING)
def test_a_command_takes_every_option_that_it_asks_for(name: str) -> None:
    module, parser = command(name), ArgumentParser()
    module.add_arguments(parser)
    taken = {action.dest for action in parser._actions}
    asked = set(asked_for(module.run))
    assert asked, "it asks for nothing"
    assert asked <= taken
