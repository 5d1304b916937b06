"""The digest of what a file computes.

Of Python the syntax tree counts, without docstrings, comments, layout and annotations of functions; of C all but
comments and layout. Imports nothing of ours, so that it can be used where nothing of ours may be imported.
"""

import ast
import re
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any

COMMENT_OR_LAYOUT = re.compile(r'("(?:\\.|[^"\\])*")|/\*.*?\*/|\s+', re.S)

_UNSEEN = {ast.arg: ("annotation",), ast.FunctionDef: ("returns",), ast.ImportFrom: ("module", "level")}
"""Fields of the syntax tree that do not count: from where something is imported is told by the list of files."""


@cache
def digest(path: Path) -> str:
    """Of what a file computes."""
    content = path.read_bytes()
    if path.suffix == ".py":
        content = repr(_shape(ast.parse(content))).encode()
    elif path.suffix in (".c", ".h"):
        content = COMMENT_OR_LAYOUT.sub(lambda found: found[1] or " ", content.decode()).encode()
    return sha256(content).hexdigest()[:8]


def _shape(node: Any) -> Any:
    """A syntax tree without what computes nothing, the same from all versions of Python."""
    if isinstance(node, list):
        return [_shape(each) for each in node if not _computes_nothing(each)]
    if not isinstance(node, ast.AST):
        return node
    fields = ((name, value) for name, value in ast.iter_fields(node) if name not in _UNSEEN.get(type(node), ()))
    return type(node).__name__, [(name, _shape(value)) for name, value in fields if value is not None and value != []]


def _computes_nothing(node: Any) -> bool:
    is_docstring = isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
    return is_docstring or (isinstance(node, ast.ImportFrom) and node.module in ("typing", "collections.abc"))
