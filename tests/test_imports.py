"""Imports go one way: models <- fmus <- build_fmus; the harness runs FMUs and knows no model."""

import ast
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
OURS = {"models", "fmus", "harness", "tests", "benchmarks", "build_fmus"}

ALLOWED = {"models": {"models"}, "fmus": {"fmus", "models"}, "build_fmus": {"fmus"}, "harness": {"harness"}}

HARNESS_ALLOWED = {
    "harness/commands/build.py": {"fmus"},
    "harness/monolithic.py": {"models", "fmus"},
    "harness/coupling.py": {"models"},
    "harness/back_to_back.py": {"models", "fmus"},
    "harness/commands/back_to_back.py": {"fmus"},
    "harness/controller_design.py": {"models"},
}
"""Design, analysis and the command that builds; everything else of the harness sees only FMUs."""


def modules():
    for package in ("models", "fmus", "harness"):
        yield from (path.relative_to(ROOT).as_posix() for path in sorted((ROOT / package).rglob("*.py")))
    yield "build_fmus.py"


@pytest.mark.parametrize("path", list(modules()))
def test_imports_go_one_way(path):
    found = set()
    for node in ast.walk(ast.parse((ROOT / path).read_bytes())):
        if isinstance(node, ast.Import):
            found |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and not node.level:
            found.add((node.module or "").split(".")[0])
    allowed = ALLOWED[path.removesuffix(".py").split("/")[0]] | HARNESS_ALLOWED.get(path, set())
    assert found & OURS <= allowed


def test_the_models_use_the_standard_library_alone():
    for path in (ROOT / "models").glob("*.py"):
        for node in ast.walk(ast.parse(path.read_bytes())):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom) and not node.level:
                names = [node.module or ""]
            assert {name.split(".")[0] for name in names} <= set(sys.stdlib_module_names), path
