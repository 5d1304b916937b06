"""What the tests of the package share."""

from pathlib import Path
from shutil import copytree

import pytest

from driveline.fmus.catalogue import MANOEUVRE as FMU
from driveline.harness.commands.cli import main


@pytest.fixture(scope="session")
def fmus(native, native_builder, tmp_path_factory):
    """Folder of all native FMUs, with that of the source among them."""
    folder = tmp_path_factory.mktemp("with_source")
    copytree(native, folder / native.name)
    native_builder(FMU, folder)
    return folder


@pytest.fixture(scope="session")
def packaged(fmus, tmp_path_factory):
    """Function (options of `driveline ssp`) -> the package; each is made once."""
    made: dict[tuple[str, ...], Path] = {}

    def packaged(*options: str) -> Path:
        if options not in made:
            folder = tmp_path_factory.mktemp("ssp")
            assert main(["ssp", "--fmus", str(fmus), "--output", str(folder), "--quiet", *options]) == 0
            made[options] = folder / "driveline.ssp"
        return made[options]

    return packaged
