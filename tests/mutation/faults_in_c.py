"""Faults in C, found by the way in which the C of this project is written."""

import ast
import re
from collections.abc import Callable, Iterator
from re import Match

from tests.mutation.faults_in_python import number

NO_CODE = re.compile(
    r"""/\*.*?\*/  # comments
    | "(?:\\.|[^"\\])*" | '(?:\\.|[^'\\])'  # texts
    | ^\#[^\n]*  # lines for the preprocessor
    | \(void\)\w+;
    | \[\d+\](?=;) | ^enum\ \{[^}]*\};  # sizes of buffers
    | va_end\(\w+\);""",
    re.DOTALL | re.MULTILINE | re.VERBOSE,
)
OPERATORS = {"<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"), "==": ("!=",), "!=": ("==",)}
OPERATORS |= {"&&": ("||",), "||": ("&&",), "+": ("-",), "-": ("+",), "*": ("/",), "/": ("*",), "+=": ("-=",)}
STATUS = {"OK": "ERROR", "ERROR": "OK", "DISCARD": "OK"}


def numbers(match: Match[str]) -> list[str]:
    return [ast.unparse(other) for other in number(ast.literal_eval(match[0]))]


RULES: tuple[tuple[str, Callable[[Match[str]], list[str]]], ...] = (
    (r"(?<![\w.])\d+(?:\.\d+(?:e-?\d+)?)?(?![\w.])", numbers),
    (r"(?<= )(?:[<>=!]=|[<>]|&&|\|\||[-+*/]|\+=)(?= )", lambda m: list(OPERATORS[m[0]])),
    (r"!(?=[\w(*])", lambda m: [""]),
    (r"(?<=return )(?:OK|ERROR|DISCARD)\b", lambda m: [STATUS[m[0]]]),
    (
        r"(?<=\? )(?P<one>[^?:;()]+(?:\([^?:;]*\))?) : (?P<other>[^?:;,()]+(?:\([^?:;]*\))?)(?=[;,)])",
        lambda m: ["swap"],
    ),
    # a whole statement that declares nothing
    (r"(?:(?<=[;{})]\n)|(?<=else\n)) +(?:[*\w.>\[\]()-]+ [-+|]?= [^;{}]+|\w+\([^;{}]*\));$", lambda m: [";"]),
)
"""What is looked for, and what may stand in its place."""


def faults(source: str) -> Iterator[tuple[int, str, str]]:
    """Place in bytes, old and new text of every fault."""
    code = NO_CODE.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), source)
    for pattern, replacements in RULES:
        for match in re.finditer(pattern, code, re.MULTILINE):
            old = source[match.start() : match.end()]
            for new in replacements(match):
                if new == "swap":
                    one, other = (source[match.start(part) : match.end(part)] for part in ("one", "other"))
                    new = f"{other} : {one}"
                yield len(source[: match.start()].encode()), old, new
