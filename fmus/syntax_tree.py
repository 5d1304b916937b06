"""Syntax trees of sources, one at a time: CPython 3.11 has one count of depth for all threads (gh-106905)."""

import ast
from threading import Lock

_ONE = Lock()


def syntax_tree(source: str | bytes) -> ast.Module:
    """The tree of a module's source."""
    with _ONE:
        return ast.parse(source)
