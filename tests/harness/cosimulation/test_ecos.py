"""The complete loop in ecos, a co-simulation tool that we did not write: the same result."""

import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from driveline.harness.loop.places import BUILDS, PLANTS
from tests.harness.cosimulation.hosts import check_loop

if find_spec("ecospy") is None:
    pytest.skip("ecospy is not installed", allow_module_level=True)

LIBRARIES = str(Path(sys.prefix) / "lib")
"""Where PyPI's tbb puts what ecos loads."""


@pytest.mark.parametrize("build", BUILDS)
@pytest.mark.parametrize("plant", PLANTS)
def test_ecos_gets_what_our_master_gets_with_jacobi(plant: str, build: str, both_built: Path, tmp_path: Path) -> None:
    check_loop("ecos_host.py", plant, build, both_built, tmp_path, LD_LIBRARY_PATH=LIBRARIES)


@pytest.mark.parametrize("plant", PLANTS)
def test_ecos_gets_the_same_from_fmus_of_fmi_3(plant: str, fmi3_as_native: Path, tmp_path: Path) -> None:
    check_loop("ecos_host.py", plant, "native", fmi3_as_native, tmp_path, LD_LIBRARY_PATH=LIBRARIES)
