"""What several tests share."""

import gc
import os
import pickle
import tempfile
from collections.abc import Generator
from pathlib import Path
from shutil import copytree
from typing import Any

import pytest
from hypothesis import settings

from driveline.fmus.catalogue import FMUS
from driverecords import bounded_reading
from fmublocks.builds import builders
from fmublocks.python.packaging import build
from tests.browser import browser
from tests.compiling import caching_compiler
from tests.skipping import skipped_if_impossible

# the same examples in every run, and nothing timed
settings.register_profile("driveline", deadline=None, derandomize=True)
settings.load_profile("driveline")


def pytest_configure(config: pytest.Config) -> None:
    """Compiles through what keeps its results with the cache of pytest, unless a compiler is named from outside. What
    would start a process on each core runs in one: tests that need several say so. The parser of A2L files works by
    gRPC, whose handlers of fork abort one in a hundred of the programs that a test starts after it."""
    os.environ["LOKY_MAX_CPU_COUNT"] = "1"
    os.environ["GRPC_ENABLE_FORK_SUPPORT"] = "0"
    if "CC" not in os.environ and hasattr(config, "cache"):
        command = caching_compiler(config.cache.mkdir("compiled"))
        if command:
            os.environ["CC"] = str(command)


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


@pytest.fixture
def uncached_compiler(monkeypatch: pytest.MonkeyPatch) -> None:
    """The compiler itself, for tests of what it makes of the same source again."""
    monkeypatch.delenv("CC", raising=False)


@pytest.fixture(scope="session")
def built(tmp_path_factory):
    """Folder with all FMUs of the project, freshly built."""
    folder = tmp_path_factory.mktemp("fmus")
    for fmu in FMUS.values():
        build(fmu, folder)
    return folder


@pytest.fixture(scope="session")
def native_builder():
    """Builds an FMU natively for this machine; skips where that is not possible."""
    with skipped_if_impossible():
        (builder,) = builders("native")
    return builder


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


@pytest.fixture
def read_here(monkeypatch: pytest.MonkeyPatch) -> None:
    """Recordings are read by the process of the tests; one of their own imports packages for a second, each time."""

    def asked(_: Path, question: Any) -> Any:
        return pickle.loads(pickle.dumps(bounded_reading.outcome(*pickle.loads(pickle.dumps(question)))))

    monkeypatch.setattr(bounded_reading, "_asked", asked)


@pytest.fixture
def unpacked(tmp_path, monkeypatch):
    """Folder for temporary files, in which FMUs are unpacked."""
    folder = tmp_path / "unpacked"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    return folder


@pytest.fixture(scope="session")
def chromium(tmp_path_factory):
    """A browser for the tests of pages."""
    with browser(tmp_path_factory.mktemp("profile")) as opened:
        yield opened
