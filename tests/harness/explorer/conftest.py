"""FMUs for the explorer: those of the product, and a controller to stand beside ours."""

from collections.abc import Iterator
from pathlib import Path
from shutil import copytree
from typing import Any

import pytest

from driveline.fmus.catalogue import EVERY
from tests.harness.explorer.served import Served


@pytest.fixture(scope="session")
def with_washout(both_built: Path, native_builder: Any, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("with_washout")
    copytree(both_built, folder, dirs_exist_ok=True)
    native_builder(EVERY["SpeedWashout"], folder)
    return folder


@pytest.fixture(scope="module")
def running(with_washout: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    served = Served(with_washout, tmp_path_factory.mktemp("explored"))
    try:
        yield served
        code, errors = served.stop()
        assert (code, errors) == (130, "driveline explore: stopped\n")
    finally:
        served.process.kill()
