"""Which modules of the checkout a module imports, read from its source."""

import ast
import importlib.util
from collections.abc import Collection, Iterator
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]


def source(module: str) -> Path:
    """The file of a module, as it is named from the folder of the checkout."""
    return ROOT.joinpath(*module.split(".")).with_suffix(".py")


@cache
def imports(module: str) -> frozenset[str]:
    """What a module imports, ours without the name of the package: of `from a import b` the module a.b, or a where b
    is something in it."""
    return frozenset(_imports(module))


def _imports(module: str) -> Iterator[str]:
    package = module.rpartition(".")[0]
    for node in ast.walk(ast.parse(source(module).read_bytes())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = importlib.util.resolve_name("." * node.level + (node.module or ""), f"driveline.{package}")
            base = base.removeprefix("driveline.")
            for alias in node.names:
                yield f"{base}.{alias.name}" if source(f"{base}.{alias.name}").is_file() else base


def reached(*modules: str, without: Collection[str] = ()) -> set[str]:
    """All modules of ours that are imported with some, themselves among them.

    Args:
        without: modules and rooms that are not followed, unless they are among those that are asked for.
    """
    found, left = set(), list(modules)
    while left:
        name = left.pop()
        if name not in found and source(name).is_file():
            found.add(name)
            left += (each for each in imports(name) if not _among(each, without))
    return found


def _among(module: str, names: Collection[str]) -> bool:
    return any(f"{module}.".startswith(f"{name}.") for name in names)
