"""The emulated target: skipped where its packages are not installed; `make test-target` asks for them."""

from collections.abc import Iterator

import pytest
from fmutesting.skipping import skipped_if_impossible

from driveline.fmus.catalogue import CONTROLLERS
from driveline.harness.exchange.target.controllers import Programs, programs
from fmublocks.target.image import require_packages


@pytest.fixture(scope="session")
def target() -> Iterator[Programs]:
    """Our controller on the emulated target and on this machine."""
    with skipped_if_impossible():
        require_packages()
    with programs(CONTROLLERS["DampingController"]) as made:
        yield made
