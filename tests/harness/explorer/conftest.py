"""FMUs for the explorer: those of the product, and a controller to stand beside ours."""

from pathlib import Path
from shutil import copytree
from typing import Any

import pytest

from driveline.fmus.catalogue import EVERY


@pytest.fixture(scope="session")
def with_washout(both_built: Path, native_builder: Any, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("with_washout")
    copytree(both_built, folder, dirs_exist_ok=True)
    native_builder(EVERY["SpeedWashout"], folder)
    return folder
