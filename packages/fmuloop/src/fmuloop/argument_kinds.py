"""Arguments of public functions: one of another kind is refused by name, before it fails somewhere inside."""

from collections.abc import Iterable
from os import PathLike
from typing import Any

from toolground.plain_text import plain

from .errors import WiringError


def require_kind(name: str, value: object, kind: Any, allowed: str) -> None:
    """
    Args:
        kind: a type, or a union of several.
        allowed: what it must be, as the message says it.

    Raises:
        WiringError: it is none of them.
    """
    if not isinstance(value, kind):
        raise WiringError(f"{name} = {plain(repr(value), 60)}: it must be {allowed}")


def require_each(name: str, values: Iterable[Any], kind: Any, allowed: str) -> list[Any]:
    """The values, each of a kind; arguments as of `require_kind`.

    Raises:
        WiringError: it is a single one, a text for example, whose letters would each be taken for a value; or one is
            of another kind.
    """
    if isinstance(values, str | PathLike | kind) or not isinstance(values, Iterable):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise WiringError(f"{name} = {plain(repr(values), 60)}: it must be a list of {allowed}")
    listed = list(values)
    for value in listed:
        require_kind(f"one of {name}", value, kind, f"one of the {allowed}")
    return listed
