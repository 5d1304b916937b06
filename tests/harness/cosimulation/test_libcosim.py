"""The complete loop in libcosim, a co-simulation tool that we did not write: the same result."""

from pathlib import Path

import pytest

from driveline.harness.loop.places import BUILDS, PLANTS
from tests.harness.cosimulation.hosts import check_loop

pytest.importorskip("libcosimpy", reason="libcosimpy has no wheel for this platform")


@pytest.mark.parametrize("build", BUILDS)
@pytest.mark.parametrize("plant", PLANTS)
def test_libcosim_gets_what_our_master_gets_with_jacobi(
    plant: str, build: str, both_built: Path, tmp_path: Path
) -> None:
    check_loop("libcosim_host.py", plant, build, both_built, tmp_path)
