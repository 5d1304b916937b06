"""TOML files of anybody."""

import re
import tomllib
from pathlib import Path
from typing import Any

from .plain_text import plain

LARGEST = 1_000_000
"""Bytes of a file: those of a hundred thousand points, which are read in a second."""

DEEPEST = 10
"""Parts of a key. No key that is read has more than three, and time and memory grow with their square."""

MOST_DIGITS = 300
"""Of a number. Those of a thousand digits are no floating-point numbers, and Python does not print them."""

PART = r"""(?:[\w-]+|"(?:[^"\\\n]|\\.)*"|'[^'\n]*')[ \t]*\.[ \t]*"""
TOO_DEEP = re.compile(rf"(?<![\w-])(?:{PART}){{{DEEPEST}}}", re.ASCII)
TOO_LONG = re.compile(rf"\b[0-9](?:[xob]?[0-9A-Fa-f_]){{{MOST_DIGITS}}}", re.ASCII)


def toml_entries(path: Path) -> dict[str, Any]:
    """The entries of a file.

    Raises:
        ValueError: it is no TOML, or more than anybody writes; the message says which.
        OSError: it cannot be read.
    """
    if (size := path.stat().st_size) > LARGEST:
        raise ValueError(f"{size / 1e6:.1f} MB is too long; at most {LARGEST / 1e6:g} MB")
    try:
        text = path.read_bytes().decode("utf-8-sig")  # some editors of Windows begin a file with a mark
    except UnicodeDecodeError as error:
        raise ValueError(f"not TOML: {error}") from error
    if found := TOO_DEEP.search(text):
        raise ValueError(f"the key {plain(found[0], 40)} has more than {DEEPEST} parts")
    if found := TOO_LONG.search(text):
        raise ValueError(f"the number {plain(found[0][:40])} ... has more than {MOST_DIGITS} digits")
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # also brackets in brackets
        raise ValueError(f"not TOML: {plain(error)}") from error
