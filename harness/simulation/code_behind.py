"""Which code computes something: a module, and what it imports of the project.

The answers of a campaign belong to that code: one that goes on with another would mix the answers of both.
"""

import ast
from collections.abc import Iterator
from pathlib import Path

from fmublocks.origin import KINDS
from toolground.digest import digest_of_files
from toolground.imports import name_of, package_of, source_of, syntax_tree

PACKAGES = ("driveline", "fmucheck", "fmuloop", "fmublocks", "driverecords", "toolground")
"""Of the project."""


def digest_behind(module: str) -> str:
    """Digest of the code that a module of the project runs: of its own and of that which it imports, with the files of
    C and data beside them."""
    paths = set(modules_behind(module).values())
    beside = {path for folder in {path.parent for path in paths} for path in folder.iterdir()}
    return f"sha256:{digest_of_files(paths | {path for path in beside if path.suffix in KINDS[1:]})}"


def modules_behind(module: str) -> dict[str, Path]:
    """The files of a module of the project and of those that it imports, by their names."""
    found: dict[str, Path] = {}
    waiting = [module]
    while waiting:
        name = waiting.pop()
        if name in found or name.partition(".")[0] not in PACKAGES or (path := source_of(name)) is None:
            continue
        found[name] = path
        waiting += _imported(path, package_of(name, path))
    return found


def _imported(path: Path, package: str) -> Iterator[str]:
    for node in ast.walk(syntax_tree(path.read_bytes())):
        if isinstance(node, ast.ImportFrom):
            name = name_of(node, package)
            yield name
            if name.partition(".")[0] in PACKAGES and (file := source_of(name)) and file.name == "__init__.py":
                yield from (f"{name}.{alias.name}" for alias in node.names)
