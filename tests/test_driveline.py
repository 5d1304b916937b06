"""What users import: the names of `driveline`, each with its docstring, and nothing of ours beside it."""

import ast
import importlib
import inspect
import os
import pydoc
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from importlib import import_module
from itertools import pairwise
from pathlib import Path
from time import sleep
from types import ModuleType

import pytest

import driveline
from tests import ROOT

STUB = ROOT / "driveline" / "__init__.pyi"

DECLARED = {
    alias.asname or alias.name: (f"driveline.{node.module}" if node.level else node.module, alias.name)
    for node in ast.parse(STUB.read_bytes()).body
    if isinstance(node, ast.ImportFrom)
    for alias in node.names
}
"""Module and name there of each public name."""


def ran(code: str, folder: Path, **environment: str) -> str:
    """What a program prints that runs in a folder and finds the package of the checkout."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), **environment}
    (folder / "script.py").write_text(code, encoding="utf-8")
    command = [sys.executable, "script.py"]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_a_name_is_what_its_module_has_and_dir_gives_them() -> None:
    for name, (module, there) in DECLARED.items():
        found = getattr(driveline, name)
        if isinstance(found, ModuleType):
            assert found is import_module(f"{module}.{there}"), name
        else:
            assert found is getattr(import_module(str(module)), there), name
    assert dir(driveline) == sorted(DECLARED)
    given: dict[str, object] = {}
    exec("from driveline import *", given)
    assert given.keys() - {"__builtins__"} == DECLARED.keys()
    with pytest.raises(AttributeError, match=r"'driveline' has no attribute 'simulat'; did you mean simulate"):
        driveline.simulat  # type: ignore[attr-defined]  # noqa: B018
    with pytest.raises(AttributeError, match=r"has no attribute 'zzz'$"):
        driveline.zzz  # type: ignore[attr-defined]  # noqa: B018


def test_help_is_a_page_that_has_every_public_name_and_nothing_of_the_checkout() -> None:
    text = pydoc.plain(pydoc.render_doc(driveline))
    assert len(text.splitlines()) < 80
    assert set(DECLARED) <= set(text.split())
    assert not {"setup", "tests", "benchmarks"} & set(text.split())  # the wheel has models, fmus and harness inside


def test_a_manoeuvre_that_is_not_known_names_what_is_near() -> None:
    with pytest.raises(KeyError, match=r"^tipin_15 is not known; did you mean tipin15 or"):
        driveline.MANOEUVRES["tipin_15"]
    assert driveline.MANOEUVRES.get("tipin_15") is None


def docstring(name: str) -> str:
    """Of a name; what is neither a class, a function nor a module has it below its declaration."""
    found = getattr(driveline, name)
    if isinstance(found, ModuleType) or inspect.isclass(found) or inspect.isfunction(found):
        return found.__doc__ or ""
    body = ast.parse(inspect.getsource(import_module(str(DECLARED[name][0])))).body
    for node, below in pairwise(body):
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name) and node.target.id == name:
            return str(below.value.value) if isinstance(below, ast.Expr) else ""  # type: ignore[attr-defined]
    return ""


def test_a_name_has_a_docstring_of_its_own_that_speaks_of_public_names_alone() -> None:
    for name in DECLARED:
        text, found = docstring(name), getattr(driveline, name)
        assert text, name
        assert not text.startswith(f"{name}("), "that of a dataclass without one"
        assert not text.lstrip().startswith(("Args:", "Attributes:", "Returns:", "Raises:")), (
            f"{name}: first what it is"
        )
        parts = filter(inspect.isfunction, vars(found).values()) if inspect.isclass(found) else ()
        for each in (text, *(part.__doc__ or "" for part in parts)):
            assert not re.findall(r"\bharness\.\w+|\bdriveline\.(?:harness|models|fmus)\b", each), name
            assert set(re.findall(r"\bdriveline\.(\w+)", each)) <= DECLARED.keys(), name


def test_the_import_waits_for_nothing_and_a_missing_package_is_named(tmp_path: Path) -> None:
    loaded = ran("import sys, driveline\nprint(*sys.modules)", tmp_path).split()
    assert "driveline" in loaded
    assert not {"numpy", "scipy", "casadi", "matplotlib", "fmpy", "pandas"} & set(loaded)
    assert not [name for name in loaded if name.startswith("driveline.")]
    missing = "import sys\nsys.modules['casadi'] = None\nimport driveline\n"
    identify = "try:\n    driveline.identify\nexcept driveline.MissingExtra as error:\n    print(error)\n"
    assert "driveline-damping[identification]" in ran(missing + identify, tmp_path)


def test_the_star_leaves_out_what_needs_an_extra_that_is_not_here(monkeypatch: pytest.MonkeyPatch) -> None:
    find, given = vars(driveline)["__getattr__"], dict[str, object]()

    def found(name: str) -> object:
        if name == "identify":
            raise driveline.MissingExtra(name)
        return find(name)

    monkeypatch.setattr(driveline, "__getattr__", found)
    exec("from driveline import *", given)
    assert given.keys() - {"__builtins__"} == DECLARED.keys() - {"identify"}


def test_one_thread_at_a_time_imports_a_name(monkeypatch: pytest.MonkeyPatch) -> None:
    """Modules that import each other are half imported for the others."""
    importing: list[str] = []

    def alone(module: str, package: str | None = None) -> ModuleType:
        assert not importing
        importing.append(module)
        sleep(0.01)
        importing.remove(module)
        return import_module(module, package)

    monkeypatch.setattr(importlib, "import_module", alone)
    with ThreadPoolExecutor() as threads:
        assert list(threads.map(driveline.__getattr__, ["Ride", "Loop", "many", "Ride"]))


def test_a_script_beside_folders_of_the_same_names_runs(both_built: Path, tmp_path: Path) -> None:
    for folder in ("models", "fmus", "harness"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "__init__.py").write_text("raise ImportError('not this one')\n", encoding="utf-8")
    script = f"""\
import driveline
tipin = driveline.MANOEUVRES["tipin15"]
results = driveline.simulate(tipin, folder={str(both_built)!r})
print(driveline.evaluate(results, tipin).settling_time)
"""
    assert 0.0 < float(ran(script, tmp_path)) < 0.2
