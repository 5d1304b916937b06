"""Which room may import from which: the architecture as a table, read from the top."""

import ast
import importlib.util
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests import ROOT

COSIMULATION = {"harness", "harness.cosimulation"}

ROOMS = {
    "models.block": set(),
    "models.controller": {"models", "models.block"},
    "models.comparators": {"models.block", "models.controller"},
    "models": {"models.block", "models.controller"},
    "fmus.description": {"fmus", "models.block"},
    "fmus.python": {"fmus", "fmus.description", "models.block"},
    "fmus.native": {"fmus", "fmus.description", "models.block"},
    "fmus.target": {"fmus", "fmus.description", "fmus.native", "fmus.python", "models.block"},
    "fmus": {"fmus.description", "fmus.python", "fmus.native", "models", "models.block", "models.comparators"},
    "": {"fmus"},
    "harness.cosimulation": {"harness"},
    "harness.recordings": COSIMULATION,
    "harness.manoeuvres": COSIMULATION | {"harness.recordings"},
    "harness.metrics": {"harness", "harness.manoeuvres"},
    "harness.reports": {"harness", "harness.recordings", "harness.manoeuvres", "harness.metrics"},
    "harness.html": {"harness", "harness.manoeuvres", "harness.metrics", "harness.reports"},
    "harness.explorer": COSIMULATION | {"harness.manoeuvres", "harness.metrics", "harness.reports", "harness.html"},
    "harness.ssp": COSIMULATION | {"harness.manoeuvres"},
    "harness.compliance": COSIMULATION,
    "harness.linear": {"harness", "harness.metrics", "harness.reports", "models", "models.block", "models.controller"},
    "harness.faults": COSIMULATION | {"harness.manoeuvres", "harness.metrics", "harness.reports", "harness.html"},
    "harness.robustness": COSIMULATION
    | {"harness.manoeuvres", "harness.metrics", "harness.reports", "harness.analysis", "harness.html"},
    "harness.analysis": COSIMULATION
    | {"harness.manoeuvres", "harness.metrics", "harness.reports", "fmus", "fmus.description"}
    | {"harness.linear", "models", "models.block", "models.controller"}
    | {"harness.recordings", "harness.identification"},
    "harness.bound": {"harness", "harness.cosimulation", "harness.manoeuvres", "harness.metrics", "harness.reports"}
    | {"harness.linear", "models", "models.controller"},
    "harness.identification": {"harness", "harness.recordings", "harness.metrics", "harness.reports", "harness.html"},
    "harness.bus": {"harness", "harness.reports", "fmus", "models.block"},
    "harness.target": COSIMULATION
    | {"harness.manoeuvres", "harness.metrics", "harness.recordings", "harness.reports"}
    | {"fmus", "fmus.native", "fmus.target"},
    "harness.tuning": COSIMULATION
    | {"harness.manoeuvres", "harness.metrics", "harness.reports", "harness.analysis", "fmus", "fmus.description"}
    | {"harness.robustness", "harness.identification"},
    "harness": COSIMULATION
    | {"harness.recordings", "harness.manoeuvres", "harness.metrics", "harness.reports", "harness.commands"}
    | {"fmus"},  # harness.stale and harness.built alone: what makes an FMU is known to those who make it
    "harness.commands": COSIMULATION
    | {"harness.manoeuvres", "harness.metrics", "harness.reports", "harness.compliance", "harness.analysis", "fmus"}
    | {
        "harness.recordings",
        "harness.identification",
        "harness.bound",
        "harness.bus",
        "harness.explorer",
        "harness.faults",
        "harness.html",
        "harness.linear",
        "harness.tuning",
        "harness.robustness",
        "harness.ssp",
        "harness.target",
    },
}
"""Each room and those that it may import from; "" is build_fmus.py. FMUs know no harness, and of the harness only
the analysis, its linear loop and the bound know the models."""


def modules() -> Iterator[str]:
    yield "build_fmus"
    for package in ("models", "fmus", "harness"):
        for path in sorted((ROOT / package).rglob("*.py")):
            yield ".".join(path.relative_to(ROOT).with_suffix("").parts)


def source(module: str) -> Path:
    return ROOT.joinpath(*module.split(".")).with_suffix(".py")


def imports(module: str) -> Iterator[str]:
    """What a module imports: of `from a import b` the module a.b, or a where b is something in it."""
    package = module.rpartition(".")[0]
    for node in ast.walk(ast.parse(source(module).read_bytes())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = importlib.util.resolve_name("." * node.level + (node.module or ""), package)
            for alias in node.names:
                yield f"{base}.{alias.name}" if source(f"{base}.{alias.name}").is_file() else base


def rooms_in(module: str) -> set[str]:
    """Rooms of ours that a module imports from; what lies outside every room is a room of its own."""
    found = {
        name for name in imports(module) if name.split(".")[0] in ("models", "fmus", "harness", "tests", "benchmarks")
    }
    return {name if (ROOT / name.replace(".", "/")).is_dir() else name.rpartition(".")[0] for name in found}


@pytest.mark.parametrize("module", list(modules()))
def test_a_room_imports_from_the_rooms_that_it_may(module: str) -> None:
    room = module.rpartition(".")[0]
    assert rooms_in(module) <= ROOMS[room] | {room}


def reached(module: str) -> set[str]:
    """All modules of ours that are imported with a module, itself among them."""
    found, left = set(), [module]
    while left:
        name = left.pop()
        if name not in found and source(name).is_file():
            found.add(name)
            left += imports(name)
    return found


@pytest.mark.parametrize("room", ["cosimulation", "recordings", "manoeuvres", "metrics", "compliance"])
def test_what_runs_any_fmu_knows_nothing_of_how_ours_are_made(room: str) -> None:
    for module in modules():
        if module.startswith(f"harness.{room}."):
            assert not {name for name in reached(module) if name.startswith(("fmus.", "models."))}, module


def test_what_makes_an_fmu_is_asked_in_two_places() -> None:
    for module in set(modules()) - {"harness.stale", "harness.built"}:
        if module.startswith("harness.") and module.count(".") == 1:
            assert not {name for name in imports(module) if name.startswith("fmus")}, module


def test_the_models_use_the_standard_library_alone() -> None:
    for module in modules():
        if module.startswith("models."):
            others = {name.split(".")[0] for name in imports(module)} - {"models"}
            assert others <= set(sys.stdlib_module_names), module
