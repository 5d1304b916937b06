"""What the source of a module imports from which module."""

import ast
from importlib.util import find_spec, resolve_name
from pathlib import Path
from threading import Lock

_ONE = Lock()
"""CPython 3.11 has one count of depth for all threads that parse (gh-106905)."""


def syntax_tree(source: str | bytes) -> ast.Module:
    """The tree of a module's source."""
    with _ONE:
        return ast.parse(source)


def name_of(node: ast.ImportFrom, package: str) -> str:
    """What a statement `from NAME import ...` imports from, with all of its name.

    Args:
        package: in which it stands, that relative names begin at.
    """
    return resolve_name("." * node.level + (node.module or ""), package) if node.level else node.module or ""


def source_of(module: str) -> Path | None:
    """The Python file of a module or package; None if there is none."""
    try:
        spec = find_spec(module)
    except (ImportError, ValueError):
        return None
    return Path(spec.origin) if spec and spec.origin and spec.origin.endswith(".py") else None


def package_of(module: str, file: Path) -> str:
    """That whose names a module's relative imports begin at."""
    return module if file.name == "__init__.py" else module.rpartition(".")[0]
