"""What the tests of the fault campaign share."""

import pytest

from driveline.fmus.catalogue import SIGNAL_FAULTS as FMU
from driveline.harness.loop.places import PLANTS
from driveline.harness.loop.resolved import as_given


@pytest.fixture(scope="session")
def injector(native_builder, tmp_path_factory):
    """The native FMU of SignalFaults."""
    return native_builder(FMU, tmp_path_factory.mktemp("injector"))


@pytest.fixture(scope="session")
def loops(native):
    """With each plant, of freshly built FMUs."""
    return {plant: as_given(plant, folder=native.parent, build="native") for plant in PLANTS}
