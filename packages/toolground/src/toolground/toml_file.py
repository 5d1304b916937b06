"""TOML files of anybody."""

import re
import tomllib
from pathlib import Path
from typing import Any

from .file_limits import DEEPEST_TOML, LARGEST_TOML, MOST_DIGITS

SHOWN = 40
"""Characters of what is refused, as a message shows them."""

PART = r"""(?:[\w-]+|"(?:[^"\\\n]|\\.)*"|'[^'\n]*')[ \t]*\.[ \t]*"""
TOO_DEEP = re.compile(rf"(?<![\w-])(?:{PART}){{{DEEPEST_TOML}}}", re.ASCII)
TOO_LONG = re.compile(rf"\b[0-9](?:[xob]?[0-9A-Fa-f_]){{{MOST_DIGITS}}}", re.ASCII)

UNQUOTED = re.compile(r"\s*([\w-]+)\s*=\s*([+-]?\d[\d.eE+-]*\s*[A-Za-z°%µ:][\w°%/.^*· -]{0,20})(?=\s*(?:#|$))")
"""A line with a number and a unit, as no TOML has it."""

TEXT = r'''"""(?:[^\\]|\\.)*?"""|\'\'\'.*?\'\'\'|"(?:[^"\\\n]|\\.)*"|'[^'\n]*'|#[^\n]*'''
BRACKET = re.compile(rf"{TEXT}|(?P<opens>[\[{{])|(?P<closes>[\]}}])", re.DOTALL)
"""A bracket, or a text or comment, in which brackets are none."""


def toml_entries(path: Path) -> dict[str, Any]:
    """The entries of a file.

    Raises:
        ValueError: there is no such file, it is no TOML, or more than anybody writes; the message says which.
        OSError: it cannot be read.
    """
    if not path.is_file():
        lacks = "it is no regular file" if path.exists() else "there is no such file"
        raise ValueError("it is a folder, not a file" if path.is_dir() else lacks)
    if (size := path.stat().st_size) > LARGEST_TOML:
        raise ValueError(f"{size / 1e6:.1f} MB is too long; at most {LARGEST_TOML / 1e6:g} MB")
    try:
        content = path.read_bytes() if size else b""  # /proc/kmsg, of no size, waits for the next line
        text = content.decode("utf-8-sig")  # some editors of Windows begin a file with a mark
    except UnicodeDecodeError as error:
        raise ValueError(f"not TOML: {error}") from error
    if match := TOO_DEEP.search(text):
        raise ValueError(f"the key {match[0]!r:.{SHOWN}} has more than {DEEPEST_TOML} parts")
    if match := TOO_LONG.search(text):
        raise ValueError(f"the number {match[0]:.{SHOWN}} ... has more than {MOST_DIGITS} digits")
    _require_shallow(text)
    try:
        return tomllib.loads(text)
    except ValueError as error:
        named = re.search(r"at line (\d+)", str(error))
        line = text.split("\n")[int(named[1]) - 1].strip() if named else ""
        if match := UNQUOTED.match(line):
            advice = f'; a number with a unit stands in quotes, {match[1]} = "{match[2].strip()}"'
        else:
            advice = f": {line!r:.{SHOWN}}" if line else ""
        raise ValueError(f"not TOML: {error}{advice}") from error


def _require_shallow(text: str) -> None:
    depth = 0
    for bracket in BRACKET.finditer(text):
        depth += bool(bracket["opens"]) - bool(bracket["closes"])
        if depth > DEEPEST_TOML:
            line = text.count("\n", 0, bracket.start()) + 1
            raise ValueError(f"line {line} has brackets in brackets, more than {DEEPEST_TOML} deep")
