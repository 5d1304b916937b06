"""What several tests share."""

import gc
import os
from collections.abc import Generator
from pathlib import Path
from shutil import copytree

import pytest
from fmutesting.plugin import *  # noqa: F403  # fixtures and hooks
from fmutesting.skipping import skipped_if_impossible

from driveline.fmus.catalogue import FMUS
from fmublocks.builds import builders
from fmublocks.python.packaging import build
from tests.browser import browser


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """What is collected, and the modules that this imports, stay until the end: no collection of garbage looks for
    any in them, while they are made or later. It took a fifth of the time of all collecting."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """On several workers the tests of tests/ itself before those of its folders: they take long, and no worker should
    wait for the last of them at the end."""
    if "PYTEST_XDIST_WORKER" in os.environ:
        items.sort(key=lambda item: item.path.parent != Path(__file__).parent)


@pytest.fixture(scope="session")
def built(tmp_path_factory):
    """Folder with all FMUs of the project, freshly built."""
    folder = tmp_path_factory.mktemp("fmus")
    for fmu in FMUS.values():
        build(fmu, folder)
    return folder


@pytest.fixture(scope="session")
def native(native_builder, tmp_path_factory):
    """Folder with the native builds of all FMUs."""
    folder = tmp_path_factory.mktemp("native")
    paths = [native_builder(fmu, folder) for fmu in FMUS.values()]
    return paths[0].parent


@pytest.fixture(scope="session")
def fmi3(tmp_path_factory):
    """Folder with the FMI 3.0 builds of all FMUs."""
    with skipped_if_impossible():
        (build,) = builders(None, fmi=3)
    folder = tmp_path_factory.mktemp("fmi3")
    paths = [build(fmu, folder) for fmu in FMUS.values()]
    return paths[0].parent


@pytest.fixture(scope="session")
def fmi3_as_native(fmi3, tmp_path_factory):
    """Folder in whose folder native are the FMI 3.0 builds."""
    folder = tmp_path_factory.mktemp("fmi3_as_native")
    copytree(fmi3, folder / "native")
    return folder


@pytest.fixture(scope="session")
def both_built(built, native, tmp_path_factory):
    """Folder of the FMUs that run Python, with the native builds in its folder native."""
    folder = tmp_path_factory.mktemp("both")
    copytree(built, folder, dirs_exist_ok=True)
    copytree(native, folder / native.name)
    return folder


@pytest.fixture
def study_folder(both_built: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder in which a study runs, with the FMUs in its folder build."""
    (tmp_path / "build").symlink_to(both_built)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture(scope="session")
def chromium(tmp_path_factory):
    """A browser for the tests of pages."""
    with browser(tmp_path_factory.mktemp("profile")) as opened:
        yield opened
