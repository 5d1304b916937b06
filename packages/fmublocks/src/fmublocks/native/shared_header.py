"""shared.h: the limits, tolerances, names and sentences of Python, for C."""

import ast
import inspect
import json
from enum import IntFlag
from itertools import pairwise
from string import Formatter
from types import ModuleType
from typing import Any

from toolground.imports import syntax_tree

from .. import protocol
from ..block import explicit, implicit, integrator, runner

HEADER = """/* What Python and C share, written by fmublocks from {modules}.

A sentence is a macro that makes of its fields, as text, a format for printf and what goes into it. */
#ifndef SHARED_H
#define SHARED_H

{definitions}

#endif
"""

CONVERSIONS = {"": "%s", "d": "%u", "g": "%g"}
"""For printf, by the format of a field; a field without one is text when it comes to C."""


def shared_header() -> str:
    """shared.h: every number, text, tuple of texts and enumeration that those modules name with a capital."""
    modules = (protocol, runner, explicit, implicit, integrator)
    return HEADER.format(
        modules=", ".join(module.__name__ for module in modules),
        definitions="\n\n".join(text for module in modules for text in _definitions(module)),
    )


def _definitions(module: ModuleType) -> list[str]:
    meanings, taken = _meanings(module), _taken(module)
    definitions = [
        (name, definition(name, value))
        for name, value in vars(module).items()
        if name[0].isupper() and name not in taken
    ]
    return [f"/* {meanings[name]} */\n{text}" if name in meanings else text for name, text in definitions if text]


def _taken(module: ModuleType) -> set[str]:
    """The names that a module takes from others."""
    imports = [node for node in syntax_tree(inspect.getsource(module)).body if isinstance(node, ast.ImportFrom)]
    return {alias.name for node in imports for alias in node.names}


def _meanings(module: ModuleType) -> dict[str, str]:
    """What a module says below the assignment of a name."""
    meanings: dict[str, str] = {}
    for statements in pairwise(syntax_tree(inspect.getsource(module)).body):
        match statements:
            case ast.Assign([ast.Name(name)]), ast.Expr(ast.Constant(str() as text)):
                meanings[name] = inspect.cleandoc(text)
    return meanings


def definition(name: str, value: Any) -> str:
    """The C of a value: the enum of an IntFlag, else a #define; empty for one that is not for C."""
    match value:
        case type() if issubclass(value, IntFlag) and value is not IntFlag:
            members = ", ".join(f"{member.name} = {member.value}" for member in value)
            return f"typedef enum {{ {members} }} {name};"
        case int() | float():
            return f"#define {name} {value!r}"
        case str():
            return _sentence(name, value)
        case (str(), *_):
            return f"#define {name} {{{', '.join(map(json.dumps, value))}}}"
    return ""


def _sentence(name: str, template: str) -> str:
    """A macro whose parameters are the fields of the template."""
    text = ""
    arguments: list[str] = []
    for literal, field, conversion, _ in Formatter().parse(template):
        text += literal.replace("%", "%%")
        if field is not None:
            text += CONVERSIONS[conversion or ""]
            arguments.append(field)
    parameters = f"({', '.join(dict.fromkeys(arguments))})" if arguments else ""
    return f"#define {name}{parameters} {', '.join([json.dumps(text), *arguments])}"
