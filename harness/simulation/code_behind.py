"""Which code computes something: a module, and what it imports of the project.

The answers of a campaign belong to that code: one that goes on with another would mix the answers of both.
"""

import ast
from collections.abc import Iterator
from importlib.util import find_spec, resolve_name
from pathlib import Path

from ...fmus.origin import KINDS, ROOT, code_digest
from ...fmus.source_code import syntax_tree


def digest_behind(module: str) -> str:
    """Digest of the code that a module of the project runs: of its own and of that which it imports, whatever comments,
    docstrings and layout say; with the files of C and data beside them."""
    paths = set(modules_behind(module).values())
    beside = {path for folder in {path.parent for path in paths} for path in folder.iterdir()}
    return f"sha256:{code_digest(paths | {path for path in beside if path.suffix in KINDS[1:]})}"


def modules_behind(module: str) -> dict[str, Path]:
    """The files of a module of the project and of those that it imports, by their names."""
    found: dict[str, Path] = {}
    waiting = [module]
    while waiting:
        name = waiting.pop()
        spec = find_spec(name)
        if name in found or spec is None or spec.origin is None:
            continue
        path = Path(spec.origin)
        if path.suffix != ".py" or not path.is_relative_to(ROOT):
            continue
        found[name] = path
        package = name if path.name == "__init__.py" else name.rpartition(".")[0]
        waiting += _imported(path, package)
    return found


def _imported(path: Path, package: str) -> Iterator[str]:
    for node in ast.walk(syntax_tree(path.read_bytes())):
        if isinstance(node, ast.ImportFrom) and node.level:
            name = resolve_name("." * node.level + (node.module or ""), package)
            yield name
            if not node.module:
                yield from (f"{name}.{alias.name}" for alias in node.names)
