"""The order of the rooms: each imports only from those before it, so that no circle can be."""

import sys

import pytest

from docs.studies.imports import imports, reached, source
from docs.studies.rooms import ORDER, modules, room
from tests import ROOT

KNOW_THE_MODELS = ("harness.design", "harness.identification", "harness.studies", "harness.exchange", "docs.studies")
"""Rooms beside models and fmus that may import the equations; all others see FMUs only as FMUs."""

OF_NO_FMU = {"fmus.child_process", "fmus.toml_file", "fmus.user_cache", "fmus.names"}
"""What lies in `fmus` because both it and `harness` use it, and knows of no FMU but by name."""


@pytest.mark.parametrize("module", list(modules()))
def test_a_room_imports_only_from_those_before_it(module: str) -> None:
    before = ORDER[: ORDER.index(room(module)) + 1]
    ours = {room(name) for name in imports(module) if source(name).is_file() or (ROOT / name.split(".")[0]).is_dir()}
    assert ours - {"tests"} <= set(before)


def test_every_room_has_its_place_in_the_order() -> None:
    assert {room(module) for module in modules()} == set(ORDER)


def test_files_lie_in_rooms() -> None:
    assert [path.name for path in (ROOT / "harness").glob("*.py")] == ["__init__.py"]


@pytest.mark.parametrize("module", [name for name in modules() if name.startswith("harness.")])
def test_only_design_and_studies_know_the_models(module: str) -> None:
    if not module.startswith(KNOW_THE_MODELS):
        assert not [name for name in imports(module) if name.startswith("models")]


@pytest.mark.parametrize("name", ["cosimulation", "recordings", "manoeuvres", "metrics", "exchange.compliance"])
def test_what_runs_any_fmu_knows_nothing_of_how_ours_are_made(name: str) -> None:
    for module in modules():
        if module.startswith(f"harness.{name}."):
            assert not {found for found in reached(module) - OF_NO_FMU if found.startswith(("fmus.", "models."))}, (
                module
            )


def test_what_harness_shares_with_fmus_imports_nothing_of_ours() -> None:
    assert reached(*OF_NO_FMU) == OF_NO_FMU


def test_the_models_use_the_standard_library_alone() -> None:
    for module in modules():
        if module.startswith("models."):
            others = {name.split(".")[0] for name in imports(module)} - {"models"}
            assert others <= set(sys.stdlib_module_names), module
