"""A command's arguments as one frozen record: a field is an option, with its default, its check and its help.

    @record
    class Arguments(Printing):
        seed: int = option(1, "of the noise (default: %(default)s)", seed)

An option that is False by default is a switch, one that is () can be given several times. Programs fill the record by
itself, as in `Arguments(seed=7)`.
"""

from argparse import ArgumentParser, Namespace, _ActionsContainer
from collections.abc import Callable, Mapping
from dataclasses import MISSING, Field, dataclass, field, fields
from functools import partial
from pathlib import Path
from typing import Any, TypeVar, dataclass_transform

EXPERTS = "options for experts"
"""The last group of a help, which --help-all has."""

R = TypeVar("R")


@dataclass_transform(kw_only_default=True, frozen_default=True)
def record(kind: type[R]) -> type[R]:
    """Makes a frozen record of a class of options."""
    return dataclass(frozen=True, kw_only=True)(kind)


def option(
    default: Any,
    help: str,
    parse: Callable[[str], Any] | None = None,
    *,
    read: Callable[[Any], Any] | None = None,
    group: str | None = None,
    exclusive: bool = False,
    complete: str | dict[str, Any] | None = None,
    **how: Any,
) -> Any:
    """A field of a record of arguments.

    Args:
        default: of what is typed, and of the field, unless `read` makes another value of it.
        parse: of a typed word the value; raises ArgumentTypeError.
        read: of the parsed value that of the field, once all options are right; raises UserError.
        group: heading in the help.
        exclusive: it does not go together with the others of which this is said.
        complete: what completes the value, for shtab.
        how: further arguments of `argparse.ArgumentParser.add_argument`.
    """
    how |= {"help": help, "default": default} | ({"type": parse} if parse else {})
    said = {"how": how, "read": read, "group": group, "exclusive": exclusive, "complete": complete}
    if read:
        return field(default_factory=lambda: read(default), metadata=said)
    return field(default=default, metadata=said)


expert = partial(option, group=EXPERTS)


def positional(help: str, parse: Callable[[str], Any], metavar: str, nargs: str | None = None) -> Any:
    """A field of a record of arguments that is given by its place; with `nargs` as of argparse."""
    how = {"help": help, "type": parse, "metavar": metavar, **({"nargs": nargs} if nargs else {})}
    default = {None: MISSING, "+": MISSING, "*": (), "?": None}[nargs]
    return field(default=default, metadata={"how": how, "positional": True})


def ordered(record: type) -> list[Field[Any]]:
    """The options of a record as a help lists them: its own first; those of a record that it inherits stay together."""
    names = [name for kind in record.__mro__ for name in vars(kind).get("__annotations__", ())]
    known = {each.name: each for each in fields(record)}  # type: ignore[arg-type]  # pyright knows no type of dataclasses
    return [known[name] for name in reversed(dict.fromkeys(reversed(names)))]


def add_arguments(parser: ArgumentParser, record: type) -> None:
    """Adds the options of a record to a parser."""
    groups: dict[str | None, _ActionsContainer] = {}
    for each in ordered(record):
        said, how = each.metadata, dict(each.metadata["how"])
        if said.get("positional"):
            parser.add_argument(each.name, **how)
            continue
        default, title = how["default"], said["group"]
        if said["exclusive"] and None not in groups:
            groups[None] = parser.add_mutually_exclusive_group()
        elif title and title not in groups:
            groups[title] = parser.add_argument_group(title)
        place = groups[title] if title or said["exclusive"] else parser
        if default is False:
            how["action"] = "store_true"
        elif default == ():
            how = {"action": "append", **how, "default": []}
        elif isinstance(default, Path):
            how["default"] = str(default)  # which is checked as what is typed is
        action = place.add_argument(f"--{each.name.rstrip('_').replace('_', '-')}", dest=each.name, **how)
        if said["complete"]:
            action.complete = said["complete"]  # type: ignore[attr-defined]  # of shtab


def filled(record: type[R], args: Namespace) -> R:
    """The record with what was typed.

    Raises:
        UserError: a value is none that the command can take.
    """
    values: Mapping[str, Any] = vars(args)
    given = {}
    for each in fields(record):  # type: ignore[arg-type]
        value, read = values[each.name], each.metadata.get("read")
        value = tuple(value) if isinstance(value, list) else value
        given[each.name] = read(value) if read else value
    return record(**given)
