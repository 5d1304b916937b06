"""What conftest.py of every package's tests, and of those of driveline, takes over."""

import os
import pickle
import tempfile
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

from .compiling import caching_compiler

# the same examples in every run, and nothing timed
settings.register_profile("same", deadline=None, derandomize=True)
settings.load_profile("same")


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


@pytest.fixture
def uncached_compiler(monkeypatch: pytest.MonkeyPatch) -> None:
    """The compiler itself, for tests of what it makes of the same source again."""
    monkeypatch.delenv("CC", raising=False)


@pytest.fixture(scope="session")
def native_builder():
    """Builds an FMU natively for this machine; skips where that is not possible."""
    from fmublocks.builds import builders
    from fmutesting.skipping import skipped_if_impossible

    with skipped_if_impossible():
        (builder,) = builders("native")
    return builder


@pytest.fixture
def read_here(monkeypatch: pytest.MonkeyPatch) -> None:
    """Recordings are read by the process of the tests; one of their own imports packages for a second, each time."""
    from driverecords import bounded_reading

    def alone(_: Path, *question: Any) -> Any:
        return pickle.loads(pickle.dumps(bounded_reading.outcome(*pickle.loads(pickle.dumps(question)))))

    monkeypatch.setattr(bounded_reading, "_alone", alone)


@pytest.fixture
def unpacked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Folder for temporary files, in which FMUs are unpacked."""
    folder = tmp_path / "unpacked"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    return folder
